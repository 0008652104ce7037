// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Path transport held against closed forms: Monte Carlo within 3σ, with σ small enough to tell a
//! fault of 1 %, and to 1e-6 where nothing is random. One file per kind of physics.

// `cfg(test)` also tells lints that helpers may unwrap.
#[cfg(test)]
mod background;
#[cfg(test)]
mod both_ways;
#[cfg(test)]
mod common;
#[cfg(test)]
mod dispersion;
#[cfg(test)]
mod emitters;
#[cfg(test)]
mod forward;
#[cfg(test)]
mod furnace;
#[cfg(test)]
mod glass;
#[cfg(test)]
mod goniometer;
#[cfg(test)]
mod guided;
#[cfg(test)]
mod landed;
#[cfg(test)]
mod light_sources;
#[cfg(test)]
mod measure;
#[cfg(test)]
mod reliability;
#[cfg(test)]
mod rooms;
#[cfg(test)]
mod scattering;
#[cfg(test)]
mod surfaces;
