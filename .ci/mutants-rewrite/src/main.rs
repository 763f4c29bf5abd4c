//! Writes faults into source text as choices: `a + b` becomes `(if crate::mutant::active(7) { (a) -
//! (b) } else { a + b })`, so that one build holds many faults, of which at most one acts in a run.
//! See docs/dev/mutants.md.
//!
//! `mutants-rewrite TREE < MUTANTS` reads a list of mutants as `cargo mutants --list --json` writes
//! it, each with a `number`, rewrites the files in the tree, and prints the numbers of those that
//! are now choices. Each stands between `/*7[*/` and `/*]7*/`, by which errors of the compiler are
//! traced to it.

use proc_macro2::{LineColumn, Span};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::error::Error;
use std::ops::Range;
use std::path::Path;
use std::{env, fs, io};
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Arm, BinOp, Block, Expr, ExprBinary, ExprStruct, ExprUnary, Signature};

#[derive(Deserialize)]
struct Mutant {
    number: usize,
    file: String,
    genre: String,
    replacement: String,
    function: Option<Function>,
    span: Place,
}

#[derive(Deserialize)]
struct Function {
    span: Place,
}

#[derive(Deserialize)]
struct Place {
    start: Point,
    end: Point,
}

/// Lines and columns count from 1, in characters.
#[derive(Deserialize)]
struct Point {
    line: usize,
    column: usize,
}

impl Point {
    fn is(&self, at: LineColumn) -> bool {
        (self.line, self.column) == (at.line, at.column + 1)
    }
}

/// A piece of the text with a fault: new text, or a part of the old, in which there may be other
/// choices.
enum Piece {
    New(String),
    Old(Range<usize>),
}

/// A choice between the text of a range (bytes) and one with a fault. What stands at an empty range
/// is put in as it is.
struct Choice {
    range: Range<usize>,
    number: usize,
    fault: Vec<Piece>,
}

/// Finds the syntax of the mutants of a file.
struct Finder<'a> {
    mutants: &'a [Mutant],
    choices: Vec<Choice>,
    /// In a constant or a constant function, where nothing can be chosen.
    constant: bool,
}

impl<'a> Finder<'a> {
    /// The mutants of a genre whose span starts where this one does.
    fn at(&self, genre: &'static str, span: Span) -> impl Iterator<Item = &'a Mutant> + use<'a> {
        let (mutants, start) = (if self.constant { &[] } else { self.mutants }, span.start());
        mutants
            .iter()
            .filter(move |m| m.genre == genre && m.span.start.is(start))
    }

    fn add(&mut self, mutant: &Mutant, range: Range<usize>, fault: impl Into<Vec<Piece>>) {
        let (number, fault) = (mutant.number, fault.into());
        self.choices.push(Choice {
            range,
            number,
            fault,
        });
    }

    fn within(&mut self, constant: bool, visit: impl FnOnce(&mut Self)) {
        let before = self.constant;
        self.constant |= constant;
        visit(self);
        self.constant = before;
    }

    /// A function that returns a value at once.
    fn function(&mut self, signature: &Signature, block: &Block) {
        let mut opaque = Opaque(false);
        opaque.visit_return_type(&signature.output);
        if self.constant || signature.constness.is_some() || opaque.0 {
            return;
        }
        let end = block.brace_token.span.close().end();
        let body = block.brace_token.span.open().byte_range().end;
        for mutant in self.mutants {
            if mutant.genre == "FnValue"
                && mutant.function.as_ref().is_some_and(|f| f.span.end.is(end))
            {
                let text = format!(
                    "if crate::mutant::active({}) {{ return {}; }}",
                    mutant.number, mutant.replacement
                );
                self.add(mutant, body..body, [Piece::New(text)]);
            }
        }
    }
}

/// Whether a type is `impl Trait`: two values of it are of one type.
struct Opaque(bool);

impl<'ast> Visit<'ast> for Opaque {
    fn visit_type_impl_trait(&mut self, _: &'ast syn::TypeImplTrait) {
        self.0 = true;
    }
}

/// Whether an operand binds variables (`if let A = b && c`), so that no block can be put around it.
fn binds(expression: &Expr) -> bool {
    match expression {
        Expr::Let(_) => true,
        Expr::Binary(ExprBinary {
            left,
            op: BinOp::And(_),
            right,
            ..
        }) => binds(left) || binds(right),
        _ => false,
    }
}

fn new(text: impl Into<String>) -> Piece {
    Piece::New(text.into())
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.function(&item.sig, &item.block);
        self.within(item.sig.constness.is_some(), |this| {
            visit::visit_item_fn(this, item)
        });
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        self.function(&item.sig, &item.block);
        self.within(item.sig.constness.is_some(), |this| {
            visit::visit_impl_item_fn(this, item)
        });
    }

    fn visit_trait_item_fn(&mut self, item: &'ast syn::TraitItemFn) {
        if let Some(block) = &item.default {
            self.function(&item.sig, block);
        }
        self.within(item.sig.constness.is_some(), |this| {
            visit::visit_trait_item_fn(this, item)
        });
    }

    fn visit_item_const(&mut self, item: &'ast syn::ItemConst) {
        self.within(true, |this| visit::visit_item_const(this, item));
    }

    fn visit_impl_item_const(&mut self, item: &'ast syn::ImplItemConst) {
        self.within(true, |this| visit::visit_impl_item_const(this, item));
    }

    fn visit_trait_item_const(&mut self, item: &'ast syn::TraitItemConst) {
        self.within(true, |this| visit::visit_trait_item_const(this, item));
    }

    fn visit_item_static(&mut self, item: &'ast syn::ItemStatic) {
        self.within(true, |this| visit::visit_item_static(this, item));
    }

    fn visit_expr_const(&mut self, block: &'ast syn::ExprConst) {
        self.within(true, |this| visit::visit_expr_const(this, block));
    }

    fn visit_type(&mut self, kind: &'ast syn::Type) {
        self.within(true, |this| visit::visit_type(this, kind));
    }

    fn visit_generic_argument(&mut self, argument: &'ast syn::GenericArgument) {
        self.within(true, |this| visit::visit_generic_argument(this, argument));
    }

    fn visit_variant(&mut self, variant: &'ast syn::Variant) {
        self.within(true, |this| visit::visit_variant(this, variant));
    }

    fn visit_expr_repeat(&mut self, array: &'ast syn::ExprRepeat) {
        self.visit_expr(&array.expr);
        self.within(true, |this| this.visit_expr(&array.len));
    }

    fn visit_expr_binary(&mut self, binary: &'ast ExprBinary) {
        let [left, right] =
            [&binary.left, &binary.right].map(|operand| operand.span().byte_range());
        for mutant in self.at("BinaryOperator", binary.op.span()) {
            if !binds(&binary.left) && !binds(&binary.right) {
                let operator = format!(") {} (", mutant.replacement);
                let fault = [
                    new("("),
                    Piece::Old(left.clone()),
                    new(operator),
                    Piece::Old(right.clone()),
                    new(")"),
                ];
                self.add(mutant, left.start..right.end, fault);
            }
        }
        visit::visit_expr_binary(self, binary);
    }

    fn visit_expr_unary(&mut self, unary: &'ast ExprUnary) {
        let operand = unary.expr.span().byte_range();
        for mutant in self.at("UnaryOperator", unary.op.span()) {
            let fault = [new(&mutant.replacement), Piece::Old(operand.clone())];
            self.add(
                mutant,
                unary.op.span().byte_range().start..operand.end,
                fault,
            );
        }
        visit::visit_expr_unary(self, unary);
    }

    fn visit_arm(&mut self, arm: &'ast Arm) {
        let guard = arm
            .guard
            .as_ref()
            .map(|(_, guard)| guard)
            .filter(|guard| !binds(guard));
        for mutant in self.at("MatchArm", arm.span()) {
            match (&arm.guard, guard) {
                (_, Some(guard)) => self.add(mutant, guard.span().byte_range(), [new("false")]),
                (None, _) => {
                    let end = arm.pat.span().byte_range().end;
                    self.add(
                        mutant,
                        end..end,
                        [new(format!(
                            " if !crate::mutant::active({})",
                            mutant.number
                        ))],
                    );
                }
                _ => {}
            }
        }
        if let Some(guard) = guard {
            for mutant in self.at("MatchArmGuard", guard.span()) {
                self.add(
                    mutant,
                    guard.span().byte_range(),
                    [new(&mutant.replacement)],
                );
            }
        }
        visit::visit_arm(self, arm);
    }

    fn visit_expr_struct(&mut self, literal: &'ast ExprStruct) {
        let whole = literal.span().byte_range();
        for pair in literal.fields.pairs() {
            let field = pair.value().span();
            let end = pair.punct().map_or(field.byte_range().end, |comma| {
                comma.span().byte_range().end
            });
            for mutant in self.at("StructField", field) {
                let fault = [
                    Piece::Old(whole.start..field.byte_range().start),
                    Piece::Old(end..whole.end),
                ];
                self.add(mutant, whole.clone(), fault);
            }
        }
        visit::visit_expr_struct(self, literal);
    }
}

/// The text of a range with the choices in it, from the `next`-th on; they are in the order of
/// their places, an outer one before those in it.
fn written(text: &str, choices: &[Choice], range: Range<usize>, mut next: usize) -> String {
    let (mut out, mut done) = (String::new(), range.start);
    while let Some(choice) = choices.get(next) {
        let (here, number) = (&choice.range, choice.number);
        next += 1;
        if here.start < done || here.end > range.end {
            continue;
        }
        out += &text[done..here.start];
        let part = |piece: &Piece| match piece {
            Piece::New(text) => text.clone(),
            Piece::Old(part) => written(text, choices, part.clone(), next),
        };
        let fault: String = choice.fault.iter().map(part).collect();
        out += &if here.is_empty() {
            format!("/*{number}[*/{fault}/*]{number}*/")
        } else {
            let truth = written(text, choices, here.clone(), next);
            format!(
                "/*{number}[*/(if crate::mutant::active({number}) {{ {fault} }} else {{ {truth} }})/*]{number}*/"
            )
        };
        done = here.end;
    }
    out + &text[done..range.end]
}

fn main() -> Result<(), Box<dyn Error>> {
    let tree = env::args().nth(1).ok_or("a tree is missing")?;
    let all: Vec<Mutant> = serde_json::from_reader(io::stdin())?;
    let mut files = BTreeMap::<String, Vec<Mutant>>::new();
    for mutant in all {
        files.entry(mutant.file.clone()).or_default().push(mutant);
    }
    let mut numbers = Vec::new();
    for (file, mutants) in files {
        let path = Path::new(&tree).join(&file);
        let text = fs::read_to_string(&path)?;
        let mut finder = Finder {
            mutants: &mutants,
            choices: Vec::new(),
            constant: false,
        };
        finder.visit_file(&syn::parse_file(&text)?);
        let mut choices = finder.choices;
        choices.sort_by_key(|c| (c.range.start, usize::MAX - c.range.end, c.number));
        numbers.extend(choices.iter().map(|c| c.number));
        fs::write(&path, written(&text, &choices, 0..text.len(), 0))?;
    }
    println!("{}", serde_json::to_string(&numbers)?);
    Ok(())
}
