//! The picture that a VRM shows itself by.

use super::store::{keep_named, named_views};
use crate::file::GltfFile;
use crate::{array_at, index_at, text_at};
use serde_json::{Value, json};

/// Puts `png` in the place of the file's thumbnail, or gives it one where it has none; true for a VRM, of which alone
/// there is a thumbnail.
///
/// A picture that also stands on a material stays there, and the thumbnail becomes a picture of its own.
pub fn set_thumbnail(file: &mut GltfFile, png: &[u8]) -> bool {
    let extensions = &file.json["extensions"];
    if extensions["VRMC_vrm"].is_object() {
        let old = index_at(&extensions["VRMC_vrm"]["meta"], "thumbnailImage");
        let free = old.filter(|&image| textures_of(&file.json, image).is_empty());
        let image = put_image(file, free, png);
        file.json["extensions"]["VRMC_vrm"]["meta"]["thumbnailImage"] = json!(image);
    } else if extensions["VRM"].is_object() {
        let texture = index_at(&extensions["VRM"]["meta"], "texture");
        let texture = texture.filter(|&texture| texture < file.list("textures").len());
        let image = texture.and_then(|texture| index_at(&file.list("textures")[texture], "source"));
        let free = image.filter(|&image| {
            texture.is_some_and(|texture| {
                textures_of(&file.json, image) == [texture] && !is_painted(&file.json, texture)
            })
        });
        let image = put_image(file, free, png);
        if free.is_none() {
            let texture = push(&mut file.json, "textures", json!({"source": image}));
            file.json["extensions"]["VRM"]["meta"]["texture"] = json!(texture);
        }
    } else {
        return false;
    }
    true
}

/// Gives the image with this number other bytes, a PNG's: all that shows it shows these.
pub fn set_image(file: &mut GltfFile, image: usize, png: &[u8]) {
    let address = text_at(&file.list("images")[image], "uri").to_string();
    put_image(file, Some(image), png);
    if file.list("images").iter().all(|image| text_at(image, "uri") != address) {
        file.images.remove(&address);
    }
}

/// Textures that show an image, whatever its format.
fn textures_of(json: &Value, image: usize) -> Vec<usize> {
    let shows = |texture: &Value| {
        let by_format = texture["extensions"].as_object().into_iter().flatten();
        std::iter::once(texture)
            .chain(by_format.map(|(_, extension)| extension))
            .any(|holder| index_at(holder, "source") == Some(image))
    };
    let textures = array_at(json, "textures").iter().enumerate();
    textures.filter(|(_, texture)| shows(texture)).map(|(texture, _)| texture).collect()
}

/// True where a texture stands on a material.
fn is_painted(json: &Value, texture: usize) -> bool {
    let mut stack = vec![&json["materials"]];
    while let Some(value) = stack.pop() {
        if index_at(value, "index") == Some(texture) {
            return true;
        }
        match value {
            Value::Array(values) => stack.extend(values),
            Value::Object(entries) => stack.extend(entries.values()),
            _ => {}
        }
    }
    let of_toon = array_at(&json["extensions"]["VRM"], "materialProperties").iter();
    of_toon
        .filter_map(|material| material["textureProperties"].as_object())
        .flat_map(|textures| textures.values())
        .any(|value| value.as_u64() == Some(texture as u64))
}

/// The image `place` becomes `png`, a new one where there is no place; gives its number.
fn put_image(file: &mut GltfFile, place: Option<usize>, png: &[u8]) -> usize {
    if file.list("buffers").is_empty() {
        file.json["buffers"] = json!([{"byteLength": 0}]);
    }
    file.binary.resize(file.binary.len().next_multiple_of(4), 0);
    let view = json!({"buffer": 0, "byteOffset": file.binary.len(), "byteLength": png.len()});
    file.binary.extend_from_slice(png);
    let place = place.filter(|&image| image < file.list("images").len());
    let old_view = place.and_then(|image| index_at(&file.list("images")[image], "bufferView"));
    let image = match place {
        Some(image) => {
            let entry = &mut file.json["images"][image];
            entry.as_object_mut().map(|entry| (entry.remove("uri"), entry.remove("bufferView")));
            entry["mimeType"] = json!("image/png");
            image
        }
        None => push(&mut file.json, "images", json!({"name": "thumbnail", "mimeType": "image/png"})),
    };
    // The old picture's view is free where nothing else names it.
    let free = old_view.filter(|view| !named_views(&file.json).contains(view));
    let number = match free.filter(|&number| number < file.list("bufferViews").len()) {
        Some(number) => {
            file.json["bufferViews"][number] = view;
            number
        }
        None => push(&mut file.json, "bufferViews", view),
    };
    file.json["images"][image]["bufferView"] = json!(number);
    if free.is_some() {
        let all = (0..file.list("bufferViews").len()).collect();
        keep_named(file, &all);
    }
    file.json["buffers"][0]["byteLength"] = json!(file.binary.len());
    image
}

/// Adds to the list `name`; gives the number of what was added.
fn push(json: &mut Value, name: &str, entry: Value) -> usize {
    if !json[name].is_array() {
        json[name] = json!([]);
    }
    let count = array_at(json, name).len();
    if let Some(list) = json[name].as_array_mut() {
        list.push(entry);
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    const PNG: &[u8] = b"\x89PNG picture";

    /// Two images in views of 8 and 12 bytes; texture 0 shows image 0, texture 1 image 1.
    fn file(extensions: Value, materials: Value) -> GltfFile {
        let json = json!({
            "buffers": [{"byteLength": 20}],
            "bufferViews": [
                {"buffer": 0, "byteOffset": 0, "byteLength": 8},
                {"buffer": 0, "byteOffset": 8, "byteLength": 12},
            ],
            "images": [{"bufferView": 0, "mimeType": "image/jpeg"}, {"bufferView": 1, "mimeType": "image/jpeg"}],
            "textures": [{"source": 0}, {"source": 1}],
            "materials": materials,
            "extensions": extensions,
        });
        GltfFile {
            name: "a.vrm".to_string(),
            json,
            binary: b"skin....face........".to_vec(),
            ..GltfFile::default()
        }
    }

    fn bytes(file: &GltfFile, image: usize) -> &[u8] {
        let view = index_at(&file.list("images")[image], "bufferView").unwrap();
        let view = &file.list("bufferViews")[view];
        let start = index_at(view, "byteOffset").unwrap();
        &file.binary[start..start + index_at(view, "byteLength").unwrap()]
    }

    #[test]
    fn a_thumbnail_of_its_own_is_replaced_and_its_bytes_go() {
        for extensions in
            [json!({"VRM": {"meta": {"texture": 1}}}), json!({"VRMC_vrm": {"meta": {"thumbnailImage": 1}}})]
        {
            let mut file = file(extensions.clone(), json!([{"t": {"index": 0}}]));
            if extensions.get("VRMC_vrm").is_some() {
                file.json["textures"].as_array_mut().unwrap().pop();
            }
            assert!(set_thumbnail(&mut file, PNG));
            assert_eq!(file.json["extensions"], extensions);
            assert_eq!(bytes(&file, 1), PNG);
            assert_eq!(bytes(&file, 0), b"skin....");
            assert_eq!(file.json["images"][1]["mimeType"], "image/png");
            assert!(!file.binary.windows(4).any(|four| four == b"face"));
            assert_eq!(file.json["buffers"][0]["byteLength"], file.binary.len());
        }
    }

    #[test]
    fn a_picture_that_is_painted_on_the_figure_stays_there() {
        let mut one = file(json!({"VRM": {"meta": {"texture": 1}}}), json!([{"t": {"index": 1}}]));
        assert!(set_thumbnail(&mut one, PNG));
        assert_eq!(one.json["extensions"]["VRM"]["meta"]["texture"], 2);
        assert_eq!(one.json["textures"][2]["source"], 2);
        assert_eq!((bytes(&one, 1), bytes(&one, 2)), (&b"face........"[..], PNG));
        let mut other = file(json!({"VRMC_vrm": {"meta": {"thumbnailImage": 1}}}), json!([]));
        assert!(set_thumbnail(&mut other, PNG));
        assert_eq!(other.json["extensions"]["VRMC_vrm"]["meta"]["thumbnailImage"], 2);
        let toon = json!([{"textureProperties": {"_MainTex": 1}}]);
        let mut third = file(json!({"VRM": {"meta": {"texture": 1}, "materialProperties": toon}}), json!([]));
        assert!(set_thumbnail(&mut third, PNG));
        assert_eq!(bytes(&third, 1), b"face........");
    }

    #[test]
    fn a_vrm_without_one_gets_one_and_another_file_none() {
        let mut vrm = file(json!({"VRMC_vrm": {"meta": {}}}), json!([]));
        assert!(set_thumbnail(&mut vrm, PNG));
        assert_eq!(vrm.json["extensions"]["VRMC_vrm"]["meta"]["thumbnailImage"], 2);
        assert_eq!(bytes(&vrm, 2), PNG);
        let mut plain = file(json!({}), json!([]));
        assert!(!set_thumbnail(&mut plain, PNG));
    }
}
