//! Text between tags.

/// Text that is no tag.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A part of a page with a heading.
pub fn section(title: &str, body: &str) -> String {
    format!("<section>\n<h2>{}</h2>\n{body}</section>\n", escape(title))
}

/// A cell of a table.
pub enum Cell {
    Text(String),
    Number(String),
    /// A bar from the middle, as a part of its half: to the left if negative.
    Bar(f64),
}

impl Cell {
    pub fn text(text: impl Into<String>) -> Cell {
        Cell::Text(text.into())
    }

    fn html(&self) -> String {
        match self {
            Cell::Text(text) => format!("<td>{}</td>", escape(text)),
            Cell::Number(text) => format!("<td class=\"number\">{}</td>", escape(text)),
            Cell::Bar(part) => {
                let width = 50.0 * part.abs().min(1.0);
                let left = if *part < 0.0 { 50.0 - width } else { 50.0 };
                let class = if *part < 0.0 { " class=\"down\"" } else { "" };
                let bar = format!("<i{class} style=\"left:{left:.1}%;width:{width:.1}%\"></i>");
                format!("<td class=\"bar\">{bar}</td>")
            }
        }
    }
}

/// A section with a table; nothing where it has no rows.
pub fn table(title: &str, head: &[&str], rows: &[Vec<Cell>]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let head = match head {
        [] => String::new(),
        _ => {
            let cells = head.iter().map(|it| format!("<th scope=\"col\">{}</th>", escape(it)));
            format!("<tr>{}</tr>\n", cells.collect::<String>())
        }
    };
    let row = |cells: &Vec<Cell>| {
        format!("<tr>{}</tr>\n", cells.iter().map(Cell::html).collect::<String>())
    };
    let rows: String = rows.iter().map(row).collect();
    section(title, &format!("<div class=\"scroll\"><table>\n{head}{rows}</table></div>\n"))
}
