// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`AlbedoTable`]: how much light leaves a rough surface after meeting one facet.
//!
//! The rest, the loss ℓ(µ), meets further facets. It is given back by a lobe that is spread as
//! ℓ(µᵢ)·ℓ(µₒ)·µₒ: the same both ways, and scaled by the mean loss 2∫ ℓ(µ) µ dµ so that nothing is
//! lost in all. Source: C. Kulla and A. Conty, "Revisiting Physically Based Shading at Imageworks",
//! SIGGRAPH course, 2017, whose lobe is carried over here to both sides of an interface.
//!
//! Between its nodes a table is linear, and its means are those of the linear function: the lobes
//! add up exactly, and only the tabulated losses have an error.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use thiserror::Error;

use super::fresnel::{dielectric_reflectance, diffuse_dielectric_reflectance, reflect, refract};
use super::microfacet::{masking_of_reflection, masking_of_transmission, Ggx};
use crate::math::DVec3;

/// The least α a rough surface can have; what is smoother is smooth.
pub const LEAST_ALPHA: f64 = 0.001;
/// Nodes over µ.
const COSINES: usize = 40;
/// Nodes over the index ratio: odd, so that one of them is η = 1.
const RATIOS: usize = 65;
/// The largest |η − 1|/(η + 1) in the table: η from 1/3 to 3.
const LARGEST_CONTRAST: f64 = 0.5;
/// Points of the quadrature over visible facets, in height and azimuth.
const FACETS: [usize; 2] = [40, 12];

/// A surface cannot be that rough.
#[derive(Debug, Error, PartialEq)]
#[error("a roughness alpha must be from {LEAST_ALPHA} to 1, not {0}")]
pub struct RoughnessError(f64);

/// One facet's reflection and transmission for every direction and index ratio, of one α.
#[derive(Debug)]
pub struct AlbedoTable {
    ggx: Ggx,
    /// The weight of every node of µ in 2∫ f(µ) µ dµ.
    weights: [f64; COSINES],
    /// ℓ(µ) of facets that reflect all.
    reflector: [f64; COSINES],
    reflector_mean: f64,
    /// Made when the first interface asks for it.
    interfaces: OnceLock<Box<[Row; RATIOS]>>,
}

/// What depends on µ, for one index ratio.
#[derive(Clone, Debug)]
struct Row {
    nodes: [Shares; COSINES],
    mean: Shares,
}

/// What becomes of light that meets one facet of an interface.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shares {
    /// The share ℓ that does not leave.
    pub loss: f64,
    /// The share that leaves on the side it came from.
    pub reflected: f64,
}

impl Shares {
    fn mix(self, other: Self, t: f64) -> Self {
        Self {
            loss: self.loss + t * (other.loss - self.loss),
            reflected: self.reflected + t * (other.reflected - self.reflected),
        }
    }
}

/// A place between two nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Between {
    at: usize,
    t: f64,
}

impl Between {
    fn new(position: f64, nodes: usize) -> Self {
        let at = (position as usize).min(nodes - 2);
        Self { at, t: (position - at as f64).clamp(0.0, 1.0) }
    }
}

impl AlbedoTable {
    /// The table of one α.
    ///
    /// # Errors
    /// `alpha` is not from [`LEAST_ALPHA`] to 1.
    pub fn new(alpha: f64) -> Result<Self, RoughnessError> {
        if !(LEAST_ALPHA..=1.0).contains(&alpha) {
            return Err(RoughnessError(alpha));
        }
        let ggx = Ggx::new(alpha);
        let weights = cosine_weights(alpha);
        let reflector = std::array::from_fn(|node| reflector_loss(ggx, node_cosine(alpha, node)));
        let reflector_mean = weights.iter().zip(reflector).map(|(w, loss)| w * loss).sum();
        Ok(Self { ggx, weights, reflector, reflector_mean, interfaces: OnceLock::new() })
    }

    /// The roughness α.
    pub fn alpha(&self) -> f64 {
        self.ggx.alpha()
    }

    pub(super) fn ggx(&self) -> Ggx {
        self.ggx
    }

    /// Where the cosine `mu` of a direction lies.
    pub(super) fn between_cosines(&self, mu: f64) -> Between {
        let t = mu * (1.0 + self.alpha()) / (mu + self.alpha());
        Between::new(t * (COSINES - 1) as f64, COSINES)
    }

    /// The loss of facets that reflect all, and its mean over all directions.
    pub(super) fn reflector_loss(&self, mu: Between) -> f64 {
        let [a, b] = [self.reflector[mu.at], self.reflector[mu.at + 1]];
        a + mu.t * (b - a)
    }

    pub(super) fn mean_reflector_loss(&self) -> f64 {
        self.reflector_mean
    }

    /// Light that comes from a direction on the side of index 1 to a side of index `eta`.
    pub(super) fn shares(&self, eta: f64, mu: Between) -> Shares {
        let (rows, ratio) = (self.rows(), between_ratios(eta));
        let along = |row: &Row| row.nodes[mu.at].mix(row.nodes[mu.at + 1], mu.t);
        along(&rows[ratio.at]).mix(along(&rows[ratio.at + 1]), ratio.t)
    }

    /// The means of [`Self::shares`] over all directions, 2∫ f(µ) µ dµ.
    pub(super) fn mean_shares(&self, eta: f64) -> Shares {
        let (rows, ratio) = (self.rows(), between_ratios(eta));
        rows[ratio.at].mean.mix(rows[ratio.at + 1].mean, ratio.t)
    }

    /// The share of the lost light that is given back on the other side.
    ///
    /// With T the diffuse transmittance of a smooth interface and ℓ₁, ℓ₂ the mean losses on its
    /// sides: t₁₂ = T₁₂·min(1, ℓ₂/ℓ₁). As n₁²·T₁₂ = n₂²·T₂₁, n₁²·t₁₂·ℓ₁ is the same both ways.
    pub(super) fn returned_through(&self, eta: f64) -> f64 {
        let [here, there] = [eta, 1.0 / eta].map(|eta| self.mean_shares(eta).loss);
        let transmittance = 1.0 - diffuse_dielectric_reflectance(eta);
        if there < here {
            transmittance * there / here
        } else {
            transmittance
        }
    }

    fn rows(&self) -> &[Row; RATIOS] {
        self.interfaces.get_or_init(|| {
            let row = |node| {
                let eta = node_ratio(node);
                let nodes: [Shares; COSINES] = std::array::from_fn(|node| {
                    interface_shares(self.ggx, node_cosine(self.alpha(), node), eta)
                });
                let mean = |f: fn(&Shares) -> f64| {
                    self.weights.iter().zip(&nodes).map(|(w, shares)| w * f(shares)).sum()
                };
                let mean = Shares { loss: mean(|s| s.loss), reflected: mean(|s| s.reflected) };
                Row { nodes, mean }
            };
            Box::new(std::array::from_fn(row))
        })
    }
}

/// The tables of a scene: one per distinct α.
#[derive(Debug, Default)]
pub struct AlbedoTables(BTreeMap<u64, Arc<AlbedoTable>>);

impl AlbedoTables {
    /// The table of one α, made when it is asked for first.
    ///
    /// # Errors
    /// `alpha` is not from [`LEAST_ALPHA`] to 1.
    pub fn of(&mut self, alpha: f64) -> Result<Arc<AlbedoTable>, RoughnessError> {
        if let Some(table) = self.0.get(&alpha.to_bits()) {
            return Ok(Arc::clone(table));
        }
        let table = Arc::new(AlbedoTable::new(alpha)?);
        self.0.insert(alpha.to_bits(), Arc::clone(&table));
        Ok(table)
    }
}

/// µ of a node: half of the nodes lie below µ = α, where hiding changes most.
fn node_cosine(alpha: f64, node: usize) -> f64 {
    // The limit µ → 0 stands for the last direction above the surface.
    let t = (node as f64 / (COSINES - 1) as f64).max(1e-4);
    alpha * t / (1.0 + alpha - t)
}

/// η of a node: contrast grows with the square of the node's distance from η = 1, near which
/// reflection at grazing incidence changes most.
fn node_ratio(node: usize) -> f64 {
    let s = 2.0 * node as f64 / (RATIOS - 1) as f64 - 1.0;
    let contrast = LARGEST_CONTRAST * s * s.abs();
    (1.0 + contrast) / (1.0 - contrast)
}

fn between_ratios(eta: f64) -> Between {
    let contrast = (eta - 1.0) / (eta + 1.0) / LARGEST_CONTRAST;
    let s = contrast.abs().sqrt().min(1.0).copysign(contrast);
    Between::new(0.5 * (s + 1.0) * (RATIOS - 1) as f64, RATIOS)
}

/// The weights of the nodes in 2∫ f(µ) µ dµ for functions that are linear between them.
fn cosine_weights(alpha: f64) -> [f64; COSINES] {
    // Over the nodes t runs evenly from 0 to 1, and t = (1 + α)µ/(µ + α).
    let cells = (COSINES - 1) as f64;
    let mut weights = [0.0; COSINES];
    let place = |node: usize| {
        let t = node as f64 / cells;
        (t, alpha * t / (1.0 + alpha - t))
    };
    // ∫ 2µ·t dµ from 0.
    let moment = |mu: f64| {
        let tail = alpha * alpha * (mu / alpha).ln_1p();
        2.0 * (1.0 + alpha) * (0.5 * mu * mu - alpha * mu + tail)
    };
    for cell in 0..COSINES - 1 {
        let [(t, below), (_, above)] = [place(cell), place(cell + 1)];
        let whole = above * above - below * below;
        let upper = (moment(above) - moment(below) - t * whole) * cells;
        weights[cell] += whole - upper;
        weights[cell + 1] += upper;
    }
    weights
}

/// The mean of `f(wi, h, Λ(wi))` over the facets that are seen from a direction of cosine `mu`.
fn mean_over_visible(ggx: Ggx, mu: f64, mut f: impl FnMut(DVec3, DVec3, f64)) -> f64 {
    let wi = DVec3::new(((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt(), 0.0, mu);
    let lambda = ggx.lambda(wi);
    let [heights, azimuths] = FACETS;
    for i in 0..heights {
        for j in 0..azimuths {
            // Both halves of the azimuths are alike.
            let u = [0.5 * (j as f64 + 0.5) / azimuths as f64, (i as f64 + 0.5) / heights as f64];
            f(wi, ggx.visible_normal(wi, u), lambda);
        }
    }
    1.0 / (heights * azimuths) as f64
}

fn reflector_loss(ggx: Ggx, mu: f64) -> f64 {
    let mut sum = 0.0;
    let share = mean_over_visible(ggx, mu, |wi, h, lambda| {
        let wo = reflect(wi, h);
        if wo.z > 0.0 {
            sum += (1.0 + lambda) * masking_of_reflection(lambda, ggx.lambda(wo));
        }
    });
    (1.0 - sum * share).max(0.0)
}

fn interface_shares(ggx: Ggx, mu: f64, eta: f64) -> Shares {
    let (mut reflected, mut transmitted) = (0.0, 0.0);
    let share = mean_over_visible(ggx, mu, |wi, h, lambda| {
        let f = dielectric_reflectance(wi.dot(h), eta);
        let wo = reflect(wi, h);
        if wo.z > 0.0 {
            reflected += f * (1.0 + lambda) * masking_of_reflection(lambda, ggx.lambda(wo));
        }
        if let Some(wo) = refract(wi, h, eta).filter(|wo| wo.z < 0.0) {
            let masking = masking_of_transmission(lambda, ggx.lambda(wo));
            transmitted += (1.0 - f) * (1.0 + lambda) * masking;
        }
    });
    let loss = (1.0 - (reflected + transmitted) * share).max(0.0);
    Shares { loss, reflected: reflected * share }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_alpha_out_of_range_is_refused() {
        for alpha in [0.0, 0.0009, 1.001, -0.5, f64::NAN] {
            let error = AlbedoTable::new(alpha).map(|_| ()).unwrap_err();
            assert!(error.to_string().starts_with("a roughness alpha must be from 0.001 to 1"));
        }
    }

    #[test]
    fn surfaces_of_one_alpha_share_one_table() {
        let mut tables = AlbedoTables::default();
        let [a, b, c] = [0.2, 0.3, 0.2].map(|alpha| tables.of(alpha).unwrap());
        assert!(Arc::ptr_eq(&a, &c) && !Arc::ptr_eq(&a, &b));
    }

    #[test]
    fn the_weights_integrate_what_is_linear_between_the_nodes() {
        for alpha in [0.001, 0.1, 1.0] {
            let weights = cosine_weights(alpha);
            let all: f64 = weights.iter().sum();
            assert!((all - 1.0).abs() < 1e-12, "{alpha}: {all}");
            assert!(weights.iter().all(|w| *w > 0.0), "{alpha}: {weights:?}");
            // ∫ 2µ·t dµ with t = (1 + α)µ/(µ + α), by the midpoint rule.
            let linear: f64 =
                weights.iter().enumerate().map(|(i, w)| w * i as f64 / (COSINES - 1) as f64).sum();
            let steps = 100_000;
            let mut sum = 0.0;
            for i in 0..steps {
                let mu = (f64::from(i) + 0.5) / f64::from(steps);
                sum += 2.0 * mu * mu * (1.0 + alpha) / (mu + alpha) / f64::from(steps);
            }
            assert!((linear - sum).abs() < 1e-6, "{alpha}: {linear} {sum}");
        }
    }
}
