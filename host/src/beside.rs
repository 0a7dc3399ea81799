//! What lies beside a `.gltf`: the addresses that it gives to its buffers and images, and the files behind these.

use std::path::Path;

/// Gives the bytes of a file by its path beside the one that names it (`textures/skin.png`); `None` where it is not there.
pub type Beside<'a> = dyn Fn(&str) -> Option<Vec<u8>> + 'a;

/// The files in the folder of the file at `path`.
pub fn folder_of(path: &Path) -> impl Fn(&str) -> Option<Vec<u8>> + use<> {
    let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
    move |beside| std::fs::read(folder.join(beside)).ok()
}

/// The path behind an address, relative to the file that names it.
///
/// `None` for an address that leads out of that file's folder (a host may convert files of strangers, whose results must
/// not hold what else is on its disk), for one of another kind (`data:`, `https:`), and for an empty one.
pub fn path_of(address: &str) -> Option<String> {
    let path = decode_percent(address)?;
    let leads_out = path.split(['/', '\\']).any(|part| part == "..");
    let absolute = path.starts_with(['/', '\\']) || path.split('/').next()?.contains(':');
    (!path.is_empty() && !leads_out && !absolute).then_some(path)
}

/// The address of a path beside the file that names it.
pub(crate) fn address_of(path: &str) -> String {
    let plain =
        |byte: u8| byte.is_ascii_alphanumeric() || b"-._~/()!$&'*+,;=@".contains(&byte) || byte >= 0x80;
    let mut address = Vec::new();
    for byte in path.bytes() {
        if plain(byte) {
            address.push(byte);
        } else {
            address.extend(format!("%{byte:02X}").bytes());
        }
    }
    // Letters beyond ASCII stay as they are: glTF takes them either way (IRI), and people can read them.
    String::from_utf8(address).unwrap_or_default()
}

fn decode_percent(address: &str) -> Option<String> {
    let mut bytes = Vec::new();
    let mut rest = address.bytes();
    while let Some(byte) = rest.next() {
        if byte == b'%' {
            let mut digit = || Some((rest.next()? as char).to_digit(16)? as u8);
            bytes.push(digit()? << 4 | digit()?);
        } else {
            bytes.push(byte);
        }
    }
    String::from_utf8(bytes).ok()
}

/// The kind of an image, by its first bytes; `told` where they say nothing.
pub(crate) fn kind_of_image<'a>(bytes: &[u8], told: &'a str) -> &'a str {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => "image/png",
        [0xFF, 0xD8, ..] => "image/jpeg",
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => "image/webp",
        [0xAB, b'K', b'T', b'X', b' ', b'2', b'0', ..] => "image/ktx2",
        _ if told.is_empty() => "image/png",
        _ => told,
    }
}

/// The bytes of a `data:` address in base64; `None` where it is not that.
pub(crate) fn decode_base64(uri: &str) -> Option<Vec<u8>> {
    let (_, text) = uri.split_once(";base64,")?;
    let text = text.trim_end_matches('=').as_bytes();
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    let (mut bits, mut bit_count) = (0u32, 0);
    for &letter in text {
        let six = match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return None,
        };
        bits = (bits << 6 | u32::from(six)) & 0xFFFF;
        bit_count += 6;
        if bit_count >= 8 {
            bit_count -= 8;
            bytes.push((bits >> bit_count) as u8);
        }
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_leads_beside_the_file_and_nowhere_else() {
        for (address, path) in [
            ("skin.png", "skin.png"),
            ("textures/my%20skin.png", "textures/my skin.png"),
            ("./a.bin", "./a.bin"),
            ("%E9%AB%AA.png", "髪.png"),
        ] {
            assert_eq!(path_of(address).as_deref(), Some(path), "{address}");
        }
        for address in [
            "",
            "../a.bin",
            "a/../../b",
            "a\\..\\..\\b",
            "%2e%2e/a",
            "/etc/passwd",
            "C:/a.bin",
            "file:///etc/passwd",
            "https://example.org/a.bin",
            "data:;base64,AAAA",
            "a%2",
            "%FF",
        ] {
            assert_eq!(path_of(address), None, "{address}");
        }
    }

    #[test]
    fn an_address_gives_its_path_back() {
        for path in ["a b#1.bin", "50%.bin", "髪.bin", "x/y.bin"] {
            assert_eq!(path_of(&address_of(path)).as_deref(), Some(path));
        }
    }
}
