//! Gives the shared library a name of its own, so that hosts find it by that name wherever it is installed.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let target = |what: &str| std::env::var(format!("CARGO_CFG_TARGET_{what}")).unwrap_or_default();
    match target("VENDOR").as_str() {
        "apple" => println!("cargo::rustc-cdylib-link-arg=-Wl,-install_name,@rpath/libsuperdeform.dylib"),
        _ if target("FAMILY") == "unix" => {
            println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libsuperdeform.so");
        }
        _ => {}
    }
}
