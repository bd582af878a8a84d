//! The project's own sources, read as data.

use std::fs;
use std::path::{Path, PathBuf};

use syn::visit::{self, Visit};

/// The repository's root.
pub(crate) fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent()
        .expect("the tests crate lies in the repository")
        .to_path_buf()
}

/// One Rust file.
pub(crate) struct SourceFile {
    /// Path from the repository's root, with forward slashes.
    pub(crate) path: String,
    /// Its text.
    pub(crate) text: String,
}

impl SourceFile {
    pub(crate) fn parse(&self) -> syn::File {
        syn::parse_file(&self.text).unwrap_or_else(|error| panic!("{}: {error}", self.path))
    }
}

/// Every Rust file below `folder` (from the root), in the order of their paths.
pub(crate) fn rust_files(folder: &str) -> Vec<SourceFile> {
    files(folder, "rs")
}

/// Every file with that ending below `folder` (from the root), in the order of their paths.
pub(crate) fn files(folder: &str, ending: &str) -> Vec<SourceFile> {
    let mut found = Vec::new();
    collect(&root().join(folder), ending, &mut found);
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

fn collect(folder: &Path, ending: &str, found: &mut Vec<SourceFile>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let path = entry.path();
        let name = entry.file_name();
        if path.is_dir() {
            if name != "target" && !name.to_string_lossy().starts_with('.') {
                collect(&path, ending, found);
            }
        } else if path.extension().is_some_and(|e| e == ending)
            && let Ok(text) = fs::read_to_string(&path)
        {
            let path = path.strip_prefix(root()).expect("collected below the root");
            found.push(SourceFile {
                path: path.to_string_lossy().replace('\\', "/"),
                text,
            });
        }
    }
}

/// Every path a file names (`use` trees flattened, and paths in code), with the line it is on.
/// Code under `#[cfg(test)]` is left out.
pub(crate) fn paths_named(file: &SourceFile) -> Vec<(usize, String)> {
    let mut collector = Paths::default();
    collector.visit_file(&file.parse());
    collector.found
}

#[derive(Default)]
struct Paths {
    found: Vec<(usize, String)>,
}

impl Paths {
    fn flatten(&mut self, tree: &syn::UseTree, prefix: &str) {
        let join = |name: &dyn std::fmt::Display| {
            if prefix.is_empty() {
                name.to_string()
            } else {
                format!("{prefix}::{name}")
            }
        };
        match tree {
            syn::UseTree::Path(path) => self.flatten(&path.tree, &join(&path.ident)),
            syn::UseTree::Name(name) => self.note(name.ident.span(), join(&name.ident)),
            syn::UseTree::Rename(rename) => self.note(rename.ident.span(), join(&rename.ident)),
            syn::UseTree::Glob(glob) => self.note(glob.star_token.spans[0], join(&"*")),
            syn::UseTree::Group(group) => group.items.iter().for_each(|tree| self.flatten(tree, prefix)),
        }
    }

    fn note(&mut self, span: proc_macro2::Span, path: String) {
        self.found.push((span.start().line, path));
    }
}

impl<'ast> Visit<'ast> for Paths {
    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        if !only_for_tests(&item.attrs) {
            visit::visit_item_mod(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        if !only_for_tests(&item.attrs) {
            self.flatten(&item.tree, "");
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names: Vec<String> = path.segments.iter().map(|s| s.ident.to_string()).collect();
        // A single name in code is a variable, or something that a `use` has brought and was found there.
        if let (Some(first), true) = (path.segments.first(), names.len() > 1) {
            self.note(first.ident.span(), names.join("::"));
        }
        visit::visit_path(self, path);
    }
}

/// Whether the attributes say `#[cfg(test)]`.
pub(crate) fn only_for_tests(attrs: &[syn::Attribute]) -> bool {
    attrs.iter().any(|attr| {
        attr.path().is_ident("cfg") && attr.parse_args::<syn::Ident>().is_ok_and(|ident| ident == "test")
    })
}
