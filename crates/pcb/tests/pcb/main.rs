//! Gerber and Excellon files against facts that they state, hand calculation and outside judges.

mod boards;
mod clearing;
mod data;
mod drawn;
mod drill_input;
mod drilling;
mod drills;
mod ending;
mod engraving;
mod gerber_input;
mod isolation;
mod judges;
mod kicad_boards;
mod kicad_plots;
mod layers;
mod merge;
mod model;
mod outline;
mod placed;
mod raster;
mod tour;
mod voronoi;
