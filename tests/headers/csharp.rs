//! `Native.g.cs`.

/// The text of `unity/Runtime/Native.g.cs`.
pub fn csharp() -> String {
    raw(safer_ffi::headers::Language::CSharp)
}

fn raw(language: safer_ffi::headers::Language) -> String {
    let mut bytes = Vec::new();
    safer_ffi::headers::builder()
        .with_language(language)
        .to_writer(&mut bytes)
        .generate()
        .expect("the exports can be listed");
    String::from_utf8(bytes).expect("text")
}
