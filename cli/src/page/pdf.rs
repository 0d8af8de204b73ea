//! Pictures for papers as PDF, made of their SVG by svg2pdf.

use std::sync::Arc;
use svg2pdf::usvg::{Options, Tree, fontdb};
use svg2pdf::{ConversionOptions, PageOptions};

/// An SVG of ours as a PDF of one page; its letters are in it, and are text.
pub fn of(svg: &str) -> Vec<u8> {
    // No font of the machine: there may be none, and a picture is the same everywhere.
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(dejavu::sans::regular().to_vec());
    fonts.set_sans_serif_family("DejaVu Sans");
    let options = Options { fontdb: Arc::new(fonts), ..Options::default() };
    let tree = Tree::from_str(svg, &options).expect("plotters writes SVG");
    let pdf = svg2pdf::to_pdf(&tree, ConversionOptions::default(), PageOptions::default());
    pdf.expect("lines and letters can be written")
}
