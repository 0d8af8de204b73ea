//! Compiles the generated parser and its scanner.

fn main() {
    let sources = ["src/parser.c", "src/scanner.c"];
    cc::Build::new()
        .include("src")
        .files(sources)
        .flag_if_supported("-Wno-unused-parameter")
        .compile("tree-sitter-fdc");
    sources.iter().for_each(|path| println!("cargo:rerun-if-changed={path}"));
}
