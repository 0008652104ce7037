// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Pearson's test of a sampler against its density.

use super::{integrate, DVec3, Dome, Numbers};

/// Cells of the grid over the directions.
const GRID: [usize; 2] = [12, 8];
const SAMPLES: usize = 100_000;
/// Cells that expect fewer are put together.
const LEAST_EXPECTED: f64 = 20.0;

/// Test directions of `sample` within a part of the sphere against `pdf`, on a grid round `dome`'s
/// axis. What falls elsewhere, or nowhere, is one more cell. Returns the normal deviate of χ²: large
/// means that they differ.
pub fn deviate(
    dome: Dome,
    is_counted: &dyn Fn(DVec3) -> bool,
    pdf: &dyn Fn(DVec3) -> f64,
    sample: &dyn Fn([f64; 3]) -> Option<DVec3>,
    seed: u64,
) -> f64 {
    let [rings, sectors] = GRID;
    let mut counts = vec![0.0; rings * sectors + 1];
    let mut numbers = Numbers(seed);
    for _ in 0..SAMPLES {
        let u = [numbers.next(), numbers.next(), numbers.next()];
        let cell = sample(u).filter(|wo| is_counted(*wo)).map_or(rings * sectors, |wo| {
            let (s, v) = dome.place(wo);
            let ring = ((s * rings as f64) as usize).min(rings - 1);
            ring * sectors + ((v * sectors as f64) as usize).min(sectors - 1)
        });
        counts[cell] += 1.0;
    }
    let density = |s: f64, v: f64| {
        let (wo, area) = dome.direction(s, v);
        if is_counted(wo) {
            pdf(wo) * area
        } else {
            0.0
        }
    };
    // A narrow grid has the sharper features.
    let tolerance = if dome.epsilon < 1e-3 { 3e-7 } else { 1e-6 };
    let mut expected: Vec<f64> = (0..rings * sectors)
        .map(|cell| {
            let side = |at: usize, of: usize| [at as f64 / of as f64, (at + 1) as f64 / of as f64];
            let (s, v) = (side(cell / sectors, rings), side(cell % sectors, sectors));
            split(s)
                .flat_map(|s| split(v).map(move |v| (s, v)))
                .map(|(s, v)| integrate(&density, s, v, 7, tolerance))
                .sum::<f64>()
                * SAMPLES as f64
        })
        .collect();
    let inside: f64 = expected.iter().sum();
    assert!(inside <= SAMPLES as f64 * (1.0 + 1e-3), "the density integrates to {inside}");
    if inside < 0.01 * SAMPLES as f64 {
        let strays: f64 = counts[..rings * sectors].iter().sum();
        return if strays < 0.02 * SAMPLES as f64 { 0.0 } else { f64::INFINITY };
    }
    expected.push((SAMPLES as f64 - inside).max(0.0));
    pooled_deviate(&counts, &expected)
}

/// A cell's side in four.
fn split([low, high]: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    let at = move |i: i32| low + (high - low) * f64::from(i) / 4.0;
    (0..4).map(move |i| [at(i), at(i + 1)])
}

fn pooled_deviate(counts: &[f64], expected: &[f64]) -> f64 {
    let (mut chi_square, mut cells) = (0.0, 0.0);
    let mut pool = (0.0, 0.0);
    let mut order: Vec<usize> = (0..counts.len()).collect();
    order.sort_by(|a, b| expected[*b].total_cmp(&expected[*a]));
    for cell in order {
        if expected[cell] >= LEAST_EXPECTED {
            chi_square += (counts[cell] - expected[cell]).powi(2) / expected[cell];
            cells += 1.0;
        } else {
            pool = (pool.0 + counts[cell], pool.1 + expected[cell]);
        }
    }
    if pool.1 >= LEAST_EXPECTED {
        chi_square += (pool.0 - pool.1).powi(2) / pool.1;
        cells += 1.0;
    } else if pool.0 > 6.0 * LEAST_EXPECTED {
        return f64::INFINITY;
    }
    assert!(cells >= 6.0, "too few cells see light: {expected:?}");
    // Wilson and Hilferty: the cube root of χ²/k is nearly normal.
    let spread = 2.0 / (9.0 * (cells - 1.0));
    ((chi_square / (cells - 1.0)).cbrt() - (1.0 - spread)) / spread.sqrt()
}

#[test]
fn a_wrong_density_is_found() {
    // Uniform directions, tested against a density that is 5 % off on one half.
    let turn = std::f64::consts::TAU;
    let sample = |u: [f64; 3]| Some(super::direction(2.0 * u[0] - 1.0, turn * u[1]));
    let dome = Dome::new(DVec3::X, 0.5);
    let off = |by: f64| move |wo: DVec3| (1.0 + by * wo.x.signum()) / (4.0 * std::f64::consts::PI);
    assert!(deviate(dome, &|_| true, &off(0.0), &sample, 1).abs() < 4.0);
    assert!(deviate(dome, &|_| true, &off(0.05), &sample, 1) > 4.0);
}
