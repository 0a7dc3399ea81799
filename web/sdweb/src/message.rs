//! A message: the size of its JSON (4 bytes, little-endian), the JSON, and one after another the bytes of the files that it
//! lists: `"files": [{"name": "a.glb", "size": 3}]`.

use serde::Serialize;
use serde_json::{Value, json};

/// A file in a message.
#[derive(Clone, Copy, Debug)]
pub struct File<'a> {
    /// Its name, or its path beside the first file.
    pub name: &'a str,
    /// What it holds.
    pub bytes: &'a [u8],
}

/// The JSON of a message; `None` where it holds less than it says.
pub fn json_of(message: &[u8]) -> Option<(Value, &[u8])> {
    let (size, rest) = message.split_first_chunk::<4>()?;
    let (json, files) = rest.split_at_checked(u32::from_le_bytes(*size) as usize)?;
    Some((serde_json::from_slice(json).ok()?, files))
}

/// The files that `json` lists; `None` where `bytes` are fewer.
pub fn files_of<'a>(json: &'a Value, mut bytes: &'a [u8]) -> Option<Vec<File<'a>>> {
    let listed = json["files"].as_array().map_or(&[][..], Vec::as_slice);
    let file = |entry: &'a Value| {
        let (of_file, rest) = bytes.split_at_checked(entry["size"].as_u64()? as usize)?;
        bytes = rest;
        Some(File { name: entry["name"].as_str()?, bytes: of_file })
    };
    listed.iter().map(file).collect()
}

/// The message of `json` and files.
pub fn message(mut json: Value, files: &[(String, Vec<u8>)]) -> Vec<u8> {
    #[derive(Serialize)]
    struct Entry<'a> {
        name: &'a str,
        size: usize,
    }
    if !files.is_empty() {
        let entries: Vec<Entry> =
            files.iter().map(|(name, bytes)| Entry { name, size: bytes.len() }).collect();
        json["files"] = json!(entries);
    }
    let json = json.to_string().into_bytes();
    let size = 4 + json.len() + files.iter().map(|(_, bytes)| bytes.len()).sum::<usize>();
    let mut message = Vec::with_capacity(size);
    message.extend((json.len() as u32).to_le_bytes());
    message.extend(json);
    for (_, bytes) in files {
        message.extend(bytes);
    }
    message
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_sent_arrives() {
        let sent = [("a".to_string(), vec![1, 2, 3]), ("b/c".to_string(), vec![])];
        let bytes = message(json!({"do": "x"}), &sent);
        let (json, rest) = json_of(&bytes).unwrap();
        let files = files_of(&json, rest).unwrap();
        assert_eq!(json["do"], "x");
        assert_eq!(
            files.iter().map(|file| (file.name, file.bytes)).collect::<Vec<_>>(),
            [("a", &[1, 2, 3][..]), ("b/c", &[][..])]
        );
        for cut in 0..bytes.len() {
            let whole = json_of(&bytes[..cut]).is_some_and(|(json, rest)| files_of(&json, rest).is_some());
            assert!(!whole, "{cut} bytes of {} are a message", bytes.len());
        }
    }
}
