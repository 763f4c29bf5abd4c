//! Parts common to all HTML pages. Texts of inputs are escaped only here.

mod cite;
mod inputs;
mod laws;
pub(crate) mod report;
mod results;
mod verdict;

pub(crate) use verdict::{Verdict, item};

pub(crate) use inputs::{difference_table, differing};
pub(crate) use results::value;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::Value;
use sha2::{Digest, Sha256};

const STYLE: [&str; 3] = [
    include_str!("../../../assets/uPlot.min.css"),
    include_str!("../../../assets/page.css"),
    include_str!("../../../assets/print.css"),
];

/// Scripts of all pages.
const CHARTS: [&str; 8] = [
    include_str!("../../../assets/uPlot.min.js"),
    include_str!("../../../assets/unpack.js"),
    include_str!("../../../assets/units.js"),
    include_str!("../../../assets/colours.js"),
    include_str!("../../../assets/legend.js"),
    include_str!("../../../assets/charts.js"),
    include_str!("../../../assets/figures.js"),
    include_str!("../../../assets/search.js"),
];

/// Scripts of the viewer.
const VIEWER: [&str; 7] = [
    include_str!("../../../assets/gl.js"),
    include_str!("../../../assets/camera.js"),
    include_str!("../../../assets/geometry.js"),
    include_str!("../../../assets/scene.js"),
    include_str!("../../../assets/pick.js"),
    include_str!("../../../assets/controls.js"),
    include_str!("../../../assets/viewer.js"),
];

const START: &str = include_str!("../../../assets/start.js");

/// A page to be written.
#[derive(Default)]
pub(crate) struct Page {
    /// Title, not escaped.
    pub title: String,
    /// Body, as HTML.
    pub body: String,
    /// Data that the scripts read.
    pub data: Value,
    /// Packed arrays by identity.
    pub blobs: Vec<(String, String)>,
    /// Whether the page has a viewer.
    pub viewer: bool,
}

impl Page {
    /// Returns the page as one text.
    pub fn html(&self) -> String {
        let style = STYLE.join("\n");
        let viewer: &[&str] = if self.viewer { &VIEWER } else { &[] };
        let script = [&CHARTS, viewer, &[START]].concat().join("\n");
        let hash = |text: &str| STANDARD.encode(Sha256::digest(text.as_bytes()));
        let size: usize = self.blobs.iter().map(|b| b.1.len() + 80).sum();
        let mut out =
            String::with_capacity(size + script.len() + style.len() + self.body.len() + (1 << 16));
        out += "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
        out += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
        out += "<meta name=\"color-scheme\" content=\"light dark\">\n";
        out += &format!(
            "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'sha256-{}'; \
             style-src 'sha256-{}'; img-src data:; base-uri 'none'; form-action 'none'\">\n",
            hash(&script),
            hash(&style)
        );
        out += "<meta name=\"generator\" content=\"fretwork\">\n";
        out += &format!(
            "<title>{}</title>\n<style>{style}</style>\n</head>\n<body>\n",
            escape(&self.title)
        );
        out += &self.body;
        out += &format!(
            "<script type=\"application/json\" id=\"data\">{}</script>\n",
            json_in_html(&self.data)
        );
        for (id, text) in &self.blobs {
            out += &format!("<script type=\"text/plain\" id=\"{}\">", escape(id));
            out += text;
            out += "</script>\n";
        }
        out += &format!("<script>{script}</script>\n</body>\n</html>\n");
        out
    }
}

/// Escapes a text for HTML elements and attributes. Characters that change the direction of text
/// are shown by their codes.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            '\'' => out += "&#39;",
            '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {
                out += &format!("\\u{{{:x}}}", c as u32)
            }
            '\n' | '\t' => out.push(c),
            c if c.is_control() => out += &format!("\\u{{{:x}}}", c as u32),
            c => out.push(c),
        }
    }
    out
}

/// Returns JSON for a script element, which it cannot end.
fn json_in_html(value: &Value) -> String {
    value
        .to_string()
        .replace('<', "\\u003c")
        .replace("\u{2028}", "\\u2028")
        .replace("\u{2029}", "\\u2029")
}

/// A SHA-256 or an identity, which is shown shortened and copied whole.
pub(crate) fn hash(text: &str) -> String {
    format!(
        "<code class=\"hash\" title=\"{0}\">{0}</code>",
        escape(text)
    )
}

/// Returns the end of a page: the program that made it, and the licences of its content.
pub(crate) fn footer(command: &str) -> String {
    format!(
        "<footer><p>Made by <code>{command}</code>. The page is complete in itself and loads nothing.</p>\n\
         <details><summary>Figures are drawn with uPlot; its licence</summary><pre>{}</pre></details></footer>\n",
        escape(include_str!("../../../assets/uPlot.LICENSE"))
    )
}

/// Returns a table that scrolls sideways, from its attributes, a label for screen readers, column
/// heads, and rows as HTML.
pub(crate) fn table<H: AsRef<str>>(of: &str, label: &str, heads: &[H], rows: &str) -> String {
    let head = |h: &H| format!("<th scope=\"col\">{}</th>", escape(h.as_ref()));
    let heads: String = heads.iter().map(head).collect();
    format!(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{label}\"><table{of}>\
         <thead><tr>{heads}</tr></thead>\n<tbody>\n{rows}</tbody></table></div>\n"
    )
}

/// Returns a section with its heading.
pub(crate) fn section(id: &str, title: &str, body: &str) -> String {
    format!(
        "<section id=\"{id}\" aria-labelledby=\"{id}-title\">\n<h2 id=\"{id}-title\">{}</h2>\n{body}</section>\n",
        escape(title)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn nothing_in_a_text_is_markup_or_ends_a_script() {
        assert_eq!(
            escape("</script><b a='1'>&\"\u{7}\u{202e}"),
            "&lt;/script&gt;&lt;b a=&#39;1&#39;&gt;&amp;&quot;\\u{7}\\u{202e}"
        );
        let text = json_in_html(&json!({"a": "</script><!--"}));
        assert!(!text.contains('<'), "{text}");
        assert_eq!(
            serde_json::from_str::<Value>(&text).unwrap(),
            json!({"a": "</script><!--"})
        );
    }

    #[test]
    fn the_policy_names_the_script_and_the_style_of_the_page() {
        let html = Page::default().html();
        let between = |a: &str, b: &str| {
            let rest = &html[html.find(a).unwrap() + a.len()..];
            rest[..rest.find(b).unwrap()].to_owned()
        };
        let style = between("<style>", "</style>");
        let from = html.rfind("<script>").unwrap() + "<script>".len();
        let script = &html[from..html.rfind("</script>").unwrap()];
        for text in [style.as_str(), script] {
            let hash = STANDARD.encode(Sha256::digest(text.as_bytes()));
            assert!(html.contains(&format!("'sha256-{hash}'")));
        }
        // No script contains the end tag of its element.
        assert!(!script.contains("</script") && !style.contains("</style"));
    }
}
