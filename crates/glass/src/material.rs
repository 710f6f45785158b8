//! What blocks are made of: a table that users edit.

use crate::machine::line_of;
use program::{Diagnostic, Rule};
use serde::Deserialize;
use std::collections::BTreeMap;

/// The table that comes with Toolpost.
pub const TABLE: &str = include_str!("../data/materials.toml");

/// A transparent material.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// What it is called.
    pub title: String,
    /// Index of refraction.
    pub index: f64,
    /// The wavelength at which it has that index, nm.
    pub wavelength: f64,
}

/// How far the wavelength of a material may be from that of the laser, nm.
const SAME_WAVELENGTH: f64 = 1.0;

/// The material `name` of the table `text`, which is the file `file`, for a laser of `wavelength` (nm).
///
/// # Errors
/// The text is no such table, does not have the material, or has an index below 1 or of another wavelength.
pub fn find(
    text: &str,
    file: &str,
    name: &str,
    wavelength: f64,
) -> Result<Material, Box<Diagnostic>> {
    let mut table: BTreeMap<String, Material> = toml::from_str(text).map_err(|error| {
        let found = Diagnostic::error(
            Rule::Materials,
            format!("is no table of materials: {}", error.message()),
        );
        found
            .file(file)
            .line(line_of(text, &error))
            .help("each material is a table with title, index and wavelength (nm)")
    })?;
    let names = table.keys().cloned().collect::<Vec<_>>().join(", ");
    let Some(material) = table.remove(name) else {
        let found = Diagnostic::error(Rule::Material, format!("has no material `{name}`"));
        return Err(found.file(file).help(format!("it has: {names}")).into());
    };
    let Material { index, wavelength: own, .. } = material;
    // Diamond has 2.4; NaN fails.
    if !(1.0..=4.0).contains(&index) {
        let found = Diagnostic::error(
            Rule::Index,
            format!("{name}: the index of refraction {index} is not from 1 to 4"),
        );
        return Err(found.file(file).help("glass has 1.4 to 1.9").into());
    }
    if (own - wavelength).abs() > SAME_WAVELENGTH || own.is_nan() {
        let message =
            format!("{name}: the index is that of {own} nm, the laser has {wavelength} nm");
        let found = Diagnostic::error(Rule::Wavelength, message).file(file);
        return Err(found
            .help("add the material with its index at the wavelength of the laser")
            .into());
    }
    Ok(material)
}
