#[test]
fn show() {
    std::fs::write("/tmp/sd.h", superdeform_headers::c_header()).unwrap();
    std::fs::write("/tmp/sd.cs", superdeform_headers::csharp()).unwrap();
}
