//! Pages that do not belong to one run: sections of text, tables and figures.

use crate::html::arrays::Arrays;
use crate::html::figures;
use crate::html::page::{Page, escape, footer, section};
use crate::html::{ReportError, write};
use fretwork_observe::chart::Chart;
use serde_json::{Value, json};
use std::path::Path;

/// A page.
#[derive(Clone, Debug, Default)]
pub struct Sheet {
    /// Heading.
    pub title: String,
    /// A paragraph below it.
    pub lead: String,
    /// Sections.
    pub sections: Vec<Section>,
    /// The command that made the page.
    pub command: String,
}

/// A section of a page.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Heading.
    pub title: String,
    /// Contents.
    pub blocks: Vec<Block>,
}

/// A block of a section.
#[derive(Clone, Debug)]
pub enum Block {
    /// A paragraph.
    Text(String),
    /// Items of a list.
    List(Vec<String>),
    /// Preformatted text.
    Code(String),
    /// A table.
    Table(SheetTable),
    /// A figure.
    Figure(Box<Chart>),
}

/// A table of texts; the first column heads the rows.
#[derive(Clone, Debug, Default)]
pub struct SheetTable {
    /// Caption of the table, as a sentence; may be empty.
    pub note: String,
    /// Heads of the columns.
    pub heads: Vec<String>,
    /// Rows.
    pub rows: Vec<Vec<String>>,
}

impl Sheet {
    /// Writes the page; returns its size in bytes.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, to: &Path) -> Result<usize, ReportError> {
        let html = self.page().html();
        write(to, &html)?;
        Ok(html.len())
    }

    fn page(&self) -> Page {
        let (mut figures, mut numbers) = (Vec::new(), Arrays::default());
        let mut body = format!(
            "<a class=\"skip\" href=\"#section-0\">Skip to the contents</a>\n<header>\n<h1>{}</h1>\n<p class=\"doc\">{}</p>\n</header>\n",
            escape(&self.title),
            escape(&self.lead)
        );
        body += "<nav aria-label=\"Sections\">";
        for (k, s) in self.sections.iter().enumerate() {
            body += &format!("<a href=\"#section-{k}\">{}</a>", escape(&s.title));
        }
        body += "</nav>\n<main>\n";
        for (k, s) in self.sections.iter().enumerate() {
            let mut inner = String::new();
            let mut open = false;
            for block in &s.blocks {
                let figure = matches!(block, Block::Figure(_));
                if figure != open {
                    inner += if figure {
                        "<div class=\"figures\">\n"
                    } else {
                        "</div>\n"
                    };
                    open = figure;
                }
                inner += &html(block, &mut figures, &mut numbers);
            }
            if open {
                inner += "</div>\n";
            }
            body += &section(&format!("section-{k}"), &s.title, &inner);
        }
        body += "</main>\n";
        body += &footer(&self.command);
        Page {
            title: format!("{} - Fretwork", self.title),
            body,
            data: json!({"runs": [], "figures": figures, "palette": figures::palette()}),
            blobs: vec![("numbers".to_owned(), numbers.packed())],
            ..Page::default()
        }
    }
}

fn html(block: &Block, figures: &mut Vec<Value>, numbers: &mut Arrays) -> String {
    match block {
        Block::Text(text) => format!("<p class=\"lead\">{}</p>\n", escape(text)),
        Block::List(items) => {
            let items: String = items
                .iter()
                .map(|i| format!("<li>{}</li>\n", escape(i)))
                .collect();
            format!("<ul>\n{items}</ul>\n")
        }
        Block::Code(text) => format!("<pre tabindex=\"0\">{}</pre>\n", escape(text)),
        Block::Table(table) => table_html(table),
        Block::Figure(chart) => {
            figures.push(figures::chart("", chart, numbers));
            format!(
                "<figure class=\"chart\" id=\"figure-{}\"></figure>\n",
                figures.len() - 1
            )
        }
    }
}

fn table_html(table: &SheetTable) -> String {
    let mut rows = String::new();
    for row in &table.rows {
        let mut cells = row.iter();
        let first = cells.next().map_or("", String::as_str);
        rows += &format!("<tr><th scope=\"row\">{}</th>", escape(first));
        for cell in cells {
            rows += &format!("<td>{}</td>", escape(cell));
        }
        rows += "</tr>\n";
    }
    let lead = match table.note.is_empty() {
        true => String::new(),
        false => format!("<p class=\"lead\">{}</p>\n", escape(&table.note)),
    };
    lead + &crate::html::page::table("", "Table", &table.heads, &rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_observe::chart::{Axis, Series};

    /// Texts are escaped, and figures are stored in the data in their order.
    #[test]
    fn a_sheet_has_its_tables_and_figures() {
        let figure = |title: &str| {
            let chart = Chart::new(title, Axis::new("a", "m"), Axis::new("b", "").log());
            let series = Series::new("curve", vec![(1.0, f64::NAN), (2e-3, 3.0)]);
            let other = Series::new("other", vec![(1.0, 2.0)]);
            Block::Figure(Box::new(chart.with(series).with(other)))
        };
        let table = Block::Table(SheetTable {
            heads: vec!["a<b".into()],
            rows: vec![vec!["1 & 2".into(), "3".into()]],
            ..SheetTable::default()
        });
        let sheet = Sheet {
            title: "A study".into(),
            sections: vec![Section {
                title: "Results".into(),
                blocks: vec![figure("one"), figure("two"), table],
            }],
            ..Sheet::default()
        };
        let page = sheet.page();
        assert!(page.body.contains("<th scope=\"col\">a&lt;b</th>"));
        assert!(
            page.body
                .contains("<th scope=\"row\">1 &amp; 2</th><td>3</td>")
        );
        assert_eq!(
            page.body.matches("<div").count(),
            page.body.matches("</div>").count()
        );
        assert_eq!(page.data["figures"][1]["title"], "two");
        let chart = &page.data["figures"][0];
        assert_eq!(chart["x"]["unit"], "m");
        assert_eq!(
            (&chart["y"]["log"], &chart["series"][0]["label"]),
            (&json!(true), &json!("curve"))
        );
        assert_eq!(chart["series"][1]["place"], 1);
        // Both charts have the same numbers, which are stored in the page once.
        assert_eq!(chart["series"], page.data["figures"][1]["series"]);
    }
}
