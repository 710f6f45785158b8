//! What blocks are made of: a table that users edit.

use crate::machine::line_of;
use program::{Diagnostic, Misread, Rule};
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
    /// What parts of the light a plate of it reflects, absorbs and lets pass; 1 in all.
    #[serde(default)]
    pub parts: Option<[f64; 3]>,
}

impl Material {
    /// What part of a pulse reaches the focus: what a plate lets pass, or else what one face does (Fresnel, along its normal).
    pub fn passes(&self) -> f64 {
        let reflected = ((self.index - 1.0) / (self.index + 1.0)).powi(2);
        self.parts.map_or(1.0 - reflected, |[_, _, passes]| passes)
    }
}

/// How far the parts of the light may be from 1 in all, as figures with a decimal of a percent are.
const ROUNDED: f64 = 0.002;

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
        let Misread { message, help } = Misread::of(error.message());
        let found =
            Diagnostic::error(Rule::Materials, format!("is no table of materials: {message}"));
        let found = found.help("each material is a table with title, index and wavelength (nm)");
        found.file(file).line(line_of(text, &error)).help(help)
    })?;
    let names = table.keys().cloned().collect::<Vec<_>>().join(", ");
    let Some(material) = table.remove(name) else {
        let found = Diagnostic::error(Rule::Material, format!("has no material `{name}`"));
        return Err(found.file(file).help(format!("it has: {names}")).into());
    };
    let Material { index, wavelength: own, parts, .. } = material;
    // Diamond has 2.4; NaN fails.
    if !(1.0..=4.0).contains(&index) {
        let found = Diagnostic::error(
            Rule::Index,
            format!("{name}: the index of refraction {index} is not from 1 to 4"),
        );
        return Err(found.file(file).help("glass has 1.4 to 1.9").into());
    }
    if let Some(parts) = parts
        && (parts.iter().any(|part| !(0.0..=1.0).contains(part))
            || (parts.iter().sum::<f64>() - 1.0).abs() > ROUNDED)
    {
        let message = format!("{name}: the parts {parts:?} of the light are not 1 in all");
        let found = Diagnostic::error(Rule::Materials, message).file(file);
        return Err(found.help("parts = [0.08, 0.05, 0.87]: reflected, absorbed, passed").into());
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
