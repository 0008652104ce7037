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

mod facets;
mod lobe;
mod nodes;

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::{Arc, OnceLock};

use thiserror::Error;

use self::facets::{interface_shares, mean_incidence, reflector_loss, FACETS};
use self::lobe::Lobe;
pub(super) use self::nodes::Between;
use self::nodes::{between_ratios, node_ratio, Spread, COSINES, RATIOS};
use super::fresnel::diffuse_dielectric_reflectance;
use super::microfacet::Ggx;
use crate::math::DVec3;

/// The least α a rough surface can have; what is smoother is smooth.
pub const LEAST_ALPHA: f64 = 0.001;
/// From this α on, light from anywhere goes on about everywhere.
const BROAD: f64 = 0.25;
/// From this α on, a reflection is spread over a few degrees.
const SPREADING: f64 = 0.03;

/// A surface cannot be that rough.
#[derive(Debug, Error, PartialEq)]
#[error("a roughness alpha must be from {LEAST_ALPHA} to 1, not {0}")]
pub struct RoughnessError(f64);

/// One facet's reflection and transmission for every direction and index ratio, of one α.
#[derive(Debug)]
pub struct AlbedoTable {
    ggx: Ggx,
    spread: Spread,
    /// The weight of every node of µ in 2∫ f(µ) µ dµ.
    weights: [f64; COSINES],
    /// µ² of every node.
    squares: [f64; COSINES],
    /// ℓ(µ) of facets that reflect all.
    reflector: [f64; COSINES],
    /// The mean cosine of incidence on the facets that are seen.
    incidence: [f64; COSINES],
    reflector_mean: f64,
    reflector_lobe: Lobe,
    /// For every node of η, made when an interface first asks for it: a scene has few ratios.
    interfaces: Box<[OnceLock<Row>]>,
}

/// What depends on µ, for one index ratio.
#[derive(Clone, Debug)]
struct Row {
    nodes: [Shares; COSINES],
    mean: Shares,
    lobe: Lobe,
    /// The diffuse transmittance of a smooth interface, coming from its thinner side.
    transmittance: f64,
}

/// One side of an interface: light that comes from it, between two rows of the table.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side<'a> {
    rows: [&'a Row; 2],
    t: f64,
}

/// Both sides of an interface, and what is given back through it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sides<'a> {
    /// The side the light comes from.
    pub here: Side<'a>,
    /// The other one.
    pub there: Side<'a>,
    /// The share of the lost light that is given back on the other side.
    ///
    /// With T the diffuse transmittance of a smooth interface and ℓ₁, ℓ₂ the mean losses on its
    /// sides: t₁₂ = T₁₂·min(1, ℓ₂/ℓ₁). As n₁²·T₁₂ = n₂²·T₂₁, n₁²·t₁₂/ℓ₂ is the same both ways.
    pub through: f64,
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
        let spread = Spread::new(alpha);
        let weights = spread.weights();
        let reflector =
            std::array::from_fn(|node| reflector_loss(FACETS, ggx, spread.cosine(node)));
        let incidence =
            std::array::from_fn(|node| mean_incidence(FACETS, ggx, spread.cosine(node)));
        let squares = std::array::from_fn(|node| spread.cosine(node).powi(2));
        Ok(Self {
            ggx,
            spread,
            weights,
            squares,
            reflector,
            incidence,
            reflector_mean: weights.iter().zip(reflector).map(|(w, loss)| w * loss).sum(),
            reflector_lobe: Lobe::new(&reflector, &squares),
            interfaces: std::iter::repeat_with(OnceLock::new).take(RATIOS).collect(),
        })
    }

    /// Whether light from anywhere goes on about everywhere.
    pub fn is_broad(&self) -> bool {
        self.alpha() >= BROAD
    }

    /// Whether light is spread so much that it can be gathered from about where it arrives.
    pub fn spreads(&self) -> bool {
        self.alpha() >= SPREADING
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
        Between::new(self.spread.below(mu), COSINES)
    }

    /// The loss of facets that reflect all.
    pub(super) fn reflector_loss(&self, mu: Between) -> f64 {
        let [a, b] = [self.reflector[mu.at], self.reflector[mu.at + 1]];
        a + mu.t * (b - a)
    }

    /// The mean cosine of incidence on the facets that are seen.
    pub(super) fn incidence(&self, mu: Between) -> f64 {
        let [a, b] = [self.incidence[mu.at], self.incidence[mu.at + 1]];
        a + mu.t * (b - a)
    }

    /// The mean of that loss over all directions.
    pub(super) fn mean_reflector_loss(&self) -> f64 {
        self.reflector_mean
    }

    /// The lobe of what reflecting facets lose, as [`Self::lobe_density`].
    pub(super) fn reflector_density(&self, mu: Between) -> f64 {
        self.reflector_lobe.density(&self.squares, mu)
    }

    /// A direction of that lobe, by two uniform numbers.
    pub(super) fn sample_reflector_lobe(&self, u: [f64; 2]) -> DVec3 {
        upward(self.reflector_lobe.sample(&self.squares, u[0]), u[1])
    }

    /// Light that comes from a side of index 1 to a side of index `eta`.
    pub(super) fn sides(&self, eta: f64) -> Sides<'_> {
        let [here, there] = [eta, 1.0 / eta].map(|eta| {
            let ratio = between_ratios(eta);
            Side { rows: [self.row(ratio.at), self.row(ratio.at + 1)], t: ratio.t }
        });
        let transmittance = if eta < 1.0 {
            eta * eta * there.mix(|row| row.transmittance)
        } else {
            here.mix(|row| row.transmittance)
        };
        let [loss, other] = [here.mean_loss(), there.mean_loss()];
        let through = if other < loss { transmittance * other / loss } else { transmittance };
        Sides { here, there, through }
    }

    /// The density per sr of [`Self::sample_lobe`], as a multiple of µ/π.
    pub(super) fn lobe_density(&self, side: Side, mu: Between) -> f64 {
        side.mix(|row| row.lobe.density(&self.squares, mu))
    }

    /// A direction on a side, nearly in proportion to ℓ(µ)·µ, by two uniform numbers.
    pub(super) fn sample_lobe(&self, side: Side, u: [f64; 2]) -> DVec3 {
        let first = 1.0 - side.t;
        let (row, u0) = if u[0] < first {
            (side.rows[0], u[0] / first)
        } else {
            (side.rows[1], (u[0] - first) / side.t)
        };
        upward(row.lobe.sample(&self.squares, u0), u[1])
    }

    fn row(&self, at: usize) -> &Row {
        self.interfaces[at].get_or_init(|| {
            let eta = node_ratio(at);
            let nodes: [Shares; COSINES] = std::array::from_fn(|node| {
                interface_shares(FACETS, self.ggx, self.spread.cosine(node), eta)
            });
            let mean = |f: fn(&Shares) -> f64| {
                self.weights.iter().zip(&nodes).map(|(w, shares)| w * f(shares)).sum()
            };
            let mean = Shares { loss: mean(|s| s.loss), reflected: mean(|s| s.reflected) };
            let lobe = Lobe::new(&nodes.map(|shares| shares.loss), &self.squares);
            let transmittance = 1.0 - diffuse_dielectric_reflectance(eta.max(1.0 / eta));
            Row { nodes, mean, lobe, transmittance }
        })
    }
}

impl Side<'_> {
    fn mix(&self, f: impl Fn(&Row) -> f64) -> f64 {
        let [a, b] = self.rows.map(f);
        a + self.t * (b - a)
    }

    /// What becomes of light from a direction.
    pub fn shares(&self, mu: Between) -> Shares {
        let [a, b] = self.rows.map(|row| row.nodes[mu.at].mix(row.nodes[mu.at + 1], mu.t));
        a.mix(b, self.t)
    }

    /// 2∫ ℓ(µ) µ dµ.
    pub fn mean_loss(&self) -> f64 {
        self.mix(|row| row.mean.loss)
    }

    /// The share of light from everywhere that one facet reflects.
    pub fn mean_reflected(&self) -> f64 {
        self.mix(|row| row.mean.reflected)
    }
}

/// The direction above the surface with a squared cosine and a uniform number for its azimuth.
fn upward(square: f64, u: f64) -> DVec3 {
    let radius = (1.0 - square).max(0.0).sqrt();
    let (sin, cos) = (TAU * u).sin_cos();
    DVec3::new(radius * cos, radius * sin, square.sqrt())
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
    fn a_table_is_right_between_its_nodes_to_a_thousandth() {
        for alpha in [0.001, 0.03, 0.3, 1.0] {
            let table = AlbedoTable::new(alpha).unwrap();
            for cos in [0.9, 0.45, 0.15, 0.04, 0.01] {
                let mu = table.between_cosines(cos);
                let exact = reflector_loss(40_000, table.ggx, cos);
                assert!((table.reflector_loss(mu) - exact).abs() < 1e-3);
                for eta in [1.0 / 1.7, 1.0 / 1.49, 0.94, 1.063, 1.49, 1.7] {
                    let exact = interface_shares(40_000, table.ggx, cos, eta);
                    let found = table.sides(eta).here.shares(mu);
                    assert!((found.loss - exact.loss).abs() < 1e-3, "{alpha} {cos} {eta}");
                    let error = (found.reflected - exact.reflected).abs();
                    assert!(error < 3e-3, "{alpha} {cos} {eta}: {error}");
                }
            }
        }
    }
}
