//! Gives a shared library a name of its own, so that hosts find it by that name wherever it is installed, and it names no folder
//! that it was built in.

fn main() {
    // Not whenever any file of the package changes: this one stands elsewhere for some.
    println!("cargo::rerun-if-env-changed=CARGO_CFG_TARGET_VENDOR");
    let variable = |name: &str| std::env::var(name).unwrap_or_default();
    let library = variable("CARGO_PKG_NAME").trim_end_matches("-capi").replace('-', "_");
    if variable("CARGO_CFG_TARGET_VENDOR") == "apple" {
        println!("cargo::rustc-cdylib-link-arg=-Wl,-install_name,@rpath/lib{library}.dylib");
    } else if variable("CARGO_CFG_TARGET_FAMILY") == "unix" {
        println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,lib{library}.so");
    }
}
