//! The page is embedded as it stands in `studio/dist`: the crate is compiled again when the page was built again.

fn main() {
    println!("cargo::rerun-if-changed=../../studio/dist");
}
