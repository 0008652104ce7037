// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Intensities by both ways: flux walked from the lights, and luminance walked from the eye.

use lamplit_core::film::{PlaneMap, Receivers, Spot, Spots};
use lamplit_core::math::{orthonormal_pair, DMat3, DVec3};
use lamplit_core::render::{render, Batch, Photometer, Progress, RenderSettings};
use lamplit_core::sampling::uniform_cone;
use lamplit_core::scene::{Camera, Projection, Scene};
use lamplit_core::transport::{LightSource, PathSettings, Shining};

use crate::common::*;

/// Walks from lights: one way on at smooth surfaces.
pub const FORWARD: PathSettings =
    PathSettings { max_depth: 2000, split_depth: 0, roulette_below: 0.1 };

/// A round receiver at (degrees from +y towards +x, degrees towards −z), by its full angle.
pub fn spot(h: f64, v: f64, full: f64) -> Spot {
    let [h, v, full] = [h, v, full].map(f64::to_radians);
    Spot { h, v, half_angle: 0.5 * full }
}

/// Receivers round the origin, whose axis is +y: H goes to +x, V to −z.
pub fn round(spots: &[Spot]) -> Receivers {
    Receivers {
        frame: DMat3::from_cols(DVec3::X, -DVec3::Z, DVec3::Y),
        centre: DVec3::ZERO,
        distance: None,
        cells: None,
        spots: Spots::new(spots),
        map: None,
        spot_bands: 0,
        cell_bands: 0,
    }
}

/// Directions of a spot, in the world, spread evenly by solid angle; each round of them anew.
fn within(spot: Spot, round: u32, count: u32) -> impl Iterator<Item = DVec3> {
    let ((sin_h, cos_h), (sin_v, cos_v)) = (spot.h.sin_cos(), spot.v.sin_cos());
    let axis = DVec3::new(sin_h * cos_v, cos_h * cos_v, -sin_v);
    let (x, y) = orthonormal_pair(axis);
    let shift = [0.618_033_988, 0.414_213_562].map(|step| f64::from(round) * step);
    (0..count).map(move |number| {
        let steps = [0.754_877_666, 0.569_840_291];
        let u = [0, 1].map(|i| (f64::from(number) * steps[i] + shift[i] + 0.3).fract());
        let local = uniform_cone(u, 1.0 - spot.half_angle.cos());
        x * local.x + y * local.y + axis * local.z
    })
}

/// The mean over a spot of what depends on the direction.
pub fn mean_over(spot: Spot, value: impl Fn(DVec3) -> f64) -> f64 {
    let count = 4096;
    within(spot, 0, count).map(value).sum::<f64>() / f64::from(count)
}

/// A measurement of a scene's own light.
pub struct Measured {
    batches: Vec<Batch>,
    solid_angles: Vec<f64>,
    pub flux: f64,
}

/// Walk `paths` of the scene's own light.
pub fn measure(scene: &Scene, spots: &[Spot], paths: u32) -> Measured {
    measure_by(scene, Shining::of(scene), spots, round(spots), (paths, FORWARD))
}

pub fn measure_by(
    scene: &Scene,
    source: impl Into<LightSource>,
    spots: &[Spot],
    receivers: Receivers,
    (paths, settings): (u32, PathSettings),
) -> Measured {
    let source = source.into();
    let flux = source.flux(scene).iter().map(|xyz| xyz[1]).sum();
    let mut meter = Photometer::new(scene, source, receivers, settings, 5).unwrap();
    meter.walk(scene, paths.div_ceil(32), None, 2, &Progress::default()).unwrap();
    assert!(meter.batches().iter().all(|batch| batch.tally.dropped_samples == 0));
    let solid_angle =
        |spot: &Spot| 4.0 * std::f64::consts::PI * (0.5 * spot.half_angle).sin().powi(2);
    let solid_angles = spots.iter().map(solid_angle).collect();
    Measured { batches: meter.batches().to_vec(), solid_angles, flux }
}

impl Measured {
    /// One number of each batch per path.
    pub fn each(&self, value: impl Fn(&Batch) -> f64) -> Estimate {
        let per_path = |batch: &Batch| value(batch) / f64::from(batch.paths);
        let values: Vec<f64> = self.batches.iter().map(per_path).collect();
        Estimate::of(values.iter())
    }

    /// X, Y or Z of a spot's intensity, over all groups.
    pub fn intensity_of(&self, spot: usize, component: usize) -> Estimate {
        let sum = |batch: &Batch| {
            batch.groups.iter().map(|group| group.spots[spot].0[component]).sum::<f64>()
        };
        self.each(sum).times(1.0 / self.solid_angles[spot])
    }

    /// A spot's luminous intensity.
    pub fn intensity(&self, spot: usize) -> Estimate {
        self.intensity_of(spot, 1)
    }

    /// The luminous flux that leaves.
    pub fn out(&self) -> Estimate {
        self.each(|batch| batch.groups.iter().map(|group| group.out.0[1]).sum())
    }

    /// The illuminance of a map's pixel.
    pub fn illuminance(&self, pixel: usize, map: &PlaneMap) -> Estimate {
        let sum = |batch: &Batch| batch.groups.iter().map(|group| group.map[pixel].0[1]).sum();
        self.each(sum).times(1.0 / map.pixel_area())
    }

    /// Sums of the shares of all ledgers: escaped, absorbed, cut, lost, chance; and the gap.
    pub fn shares(&self) -> ([f64; 5], f64) {
        let mut all = self.batches[0].ledgers[0].clone();
        let ledgers = self.batches.iter().flat_map(|batch| &batch.ledgers);
        ledgers.skip(1).for_each(|ledger| all.add(ledger));
        let balance = all.balance().unwrap();
        let absorbed = balance.absorbed.iter().sum();
        let shares = [balance.escaped, absorbed, balance.cut_by_depth, balance.lost];
        ([shares[0], shares[1], shares[2], shares[3], balance.chance], balance.gap())
    }
}

/// Rounds of eyes: their spread is σ.
const ROUNDS: u32 = 8;

/// X, Y and Z of the mean intensity over a spot, by the luminance that eyes see from there: over a
/// square of `height` mm about `middle`, each eye along a direction of its own within the spot.
pub fn seen_from(
    scene: &mut Scene,
    spot: Spot,
    (middle, height): (DVec3, f64),
    (eyes, samples): (u32, u32),
) -> [Estimate; 3] {
    let mut values: [Vec<f64>; 3] = Default::default();
    for round in 0..ROUNDS {
        let mut sums = [0.0; 3];
        for (eye, way) in within(spot, round, eyes).enumerate() {
            let (up, _) = orthonormal_pair(way);
            let projection = Projection::Orthographic { height };
            scene.camera = Camera::new(middle + way * 1e4, middle, up, projection).unwrap();
            let seed = u64::from(90 + round * eyes) + eye as u64;
            let usual = Take { side: 16, seed, ..Take::of(samples, USUAL) }.settings();
            let settings = RenderSettings { bands_per_lane: 0, layers: false, tile: 64, ..usual };
            let film = render(scene, &settings, &Progress::default()).unwrap().film;
            for (at, sum) in sums.iter_mut().enumerate() {
                *sum += film.pixels.iter().map(|pixel| pixel.mean()[at]).sum::<f64>();
            }
        }
        let scale = height * height * 1e-6 / f64::from(256 * eyes);
        for (values, sum) in values.iter_mut().zip(sums) {
            values.push(sum * scale);
        }
    }
    values.map(|own| Estimate::of(own.iter()))
}

/// Both ways agree within 3.5σ for X, Y and Z, and tell a fault of some per cent.
#[track_caller]
pub fn agree(forward: &Measured, at: usize, seen: [Estimate; 3], fine: f64) {
    for (component, eye) in seen.into_iter().enumerate() {
        let light = forward.intensity_of(at, component);
        let sigma = light.sigma.hypot(eye.sigma);
        let off = light.mean - eye.mean;
        println!("{at} {component}: light {light:?} eye {eye:?}, {:.2} σ", off / sigma);
        assert!(off.abs() <= 3.5 * sigma, "{at} {component}: light {light:?}, eye {eye:?}");
        assert!(sigma <= fine * eye.mean, "{at} {component}: light {light:?}, eye {eye:?}");
    }
}
