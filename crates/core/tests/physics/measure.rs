// SPDX-License-Identifier: Apache-2.0 OR MIT
//! What one ray of a scene sees, with its standard error, and how it is held against a closed form.
//!
//! All pixels of a measuring picture look along the same line. Each has random numbers of its own,
//! so they repeat one measurement independently: their spread gives σ, whatever the sequence.

use std::sync::Arc;

use lamplit_core::render::{render, Method, Progress, RenderSettings, Rendered};
use lamplit_core::sampling::{PixelFilter, PixelSequence};
use lamplit_core::scene::Scene;
use lamplit_core::spectrum::LANES;
use lamplit_core::transport::{Guide, PathSettings};

/// How a picture is taken.
#[derive(Clone)]
pub struct Take {
    pub side: u32,
    pub samples: u32,
    pub seed: u64,
    pub method: Method,
}

/// What the tracer does unless it is told otherwise.
pub const USUAL: PathSettings =
    PathSettings { max_depth: 2000, split_depth: 4, roulette_below: 0.05 };

/// All ways on are followed at smooth surfaces, none is ended by chance.
pub const WHOLE: PathSettings =
    PathSettings { max_depth: 2000, split_depth: 1000, roulette_below: 0.0 };

/// None is ended by chance.
pub const STEADY: PathSettings = PathSettings { roulette_below: 0.0, ..USUAL };

/// One way on is followed.
pub const SINGLE: PathSettings =
    PathSettings { max_depth: 2000, split_depth: 0, roulette_below: 0.05 };

impl Take {
    /// 8 × 8 pixels of so many samples.
    pub fn of(samples: u32, path: PathSettings) -> Self {
        Self { side: 8, samples, seed: 7, method: Method::Path(path) }
    }

    /// The same, by walks that know where light comes from.
    pub fn lit(samples: u32, path: PathSettings) -> Self {
        Self { method: Method::Lit(path), ..Self::of(samples, path) }
    }

    /// What `render` is asked for.
    pub fn settings(&self) -> RenderSettings {
        RenderSettings {
            width: self.side,
            height: self.side,
            samples: 0..self.samples,
            adaptive: false,
            target_error: None,
            time_budget: None,
            sequence: PixelSequence::Sobol,
            filter: PixelFilter::Box,
            seed: self.seed,
            method: self.method,
            counts: None,
            guide: None,
            bands_per_lane: 1,
            layers: true,
            threads: 2,
            tile: 1,
        }
    }

    /// The picture.
    pub fn picture(&self, scene: &Scene) -> Rendered {
        let rendered = render(scene, &self.settings(), &Progress::default()).unwrap();
        assert_eq!(rendered.tally.dropped_samples, 0);
        rendered
    }

    /// The mean radiance of each lane over the picture.
    pub fn lanes(&self, scene: &Scene) -> Vec<Estimate> {
        let means = self.picture(scene).film.band_means();
        (0..LANES).map(|lane| Estimate::of(means.iter().skip(lane).step_by(LANES))).collect()
    }

    /// The luminance over pictures of so many seeds: what lands is shared by the pixels of one.
    pub fn by_seeds(&self, seeds: u64, scene: &Scene, guide: Option<&Arc<Guide>>) -> Estimate {
        let mean = |seed: u64| {
            let settings = RenderSettings { seed, guide: guide.cloned(), ..self.settings() };
            let film = render(scene, &settings, &Progress::default()).unwrap().film;
            let sum: f64 = film.pixels.iter().map(|pixel| pixel.mean()[1]).sum();
            sum / film.pixels.len() as f64
        };
        let values: Vec<f64> = (0..seeds).map(|number| mean(self.seed + number)).collect();
        Estimate::of(values.iter())
    }

    /// The luminance over the picture.
    pub fn luminance(&self, scene: &Scene) -> Estimate {
        let film = self.picture(scene).film;
        let values: Vec<f64> = film.pixels.iter().map(|pixel| pixel.mean()[1]).collect();
        Estimate::of(values.iter())
    }
}

/// The largest relative σ where nothing is random.
pub const EXACT: f64 = 1e-7;

/// A mean and its standard error.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    pub mean: f64,
    pub sigma: f64,
}

impl Estimate {
    /// From independent repetitions.
    pub fn of<'a>(values: impl Iterator<Item = &'a f64>) -> Self {
        let values: Vec<f64> = values.copied().collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let spread: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        Self { mean, sigma: (spread / (n * (n - 1.0))).sqrt() }
    }

    /// In another unit.
    pub fn times(self, factor: f64) -> Self {
        Self { mean: self.mean * factor, sigma: self.sigma * factor }
    }

    /// Within 3σ of `expected`, with σ at most `fine`·expected.
    #[track_caller]
    pub fn is(self, expected: f64, fine: f64) {
        all_are(&[self], |_| expected, fine);
    }

    /// Within 3σ of `other`, with the σ of both less than `fine` of it.
    #[track_caller]
    pub fn is_as(self, other: Self, fine: f64) {
        let sigma = self.sigma.hypot(other.sigma);
        assert!((self.mean - other.mean).abs() < 3.0 * sigma, "{self:?} {other:?}");
        assert!(sigma < fine * other.mean, "{self:?} {other:?}");
    }
}

/// Each within `z`σ of what is expected, with σ at most `fine`·expected; z is 3 for one and grows so
/// that all together are as sure. A fiftieth of that is left besides for what is too rare to be met:
/// a far small lamp found by chance has a millionth of the light.
#[track_caller]
pub fn all_are(estimates: &[Estimate], expected: impl Fn(usize) -> f64, fine: f64) {
    let z = (2.0 * (90.0 * estimates.len() as f64).ln()).sqrt();
    for (at, got) in estimates.iter().enumerate() {
        let (off, expected) = (got.mean - expected(at), expected(at));
        let allowed = z * got.sigma + (0.02 * fine).max(EXACT) * expected.abs() + 1e-12;
        assert!(off.abs() <= allowed, "{at}: {got:?}, expected {expected}: {} σ", off / got.sigma);
        let limit = fine * expected.abs() + 1e-12;
        assert!(got.sigma <= limit, "{at}: {got:?}, σ should be {limit} at most");
    }
}

/// The unpolarised reflectance of an interface, by Snell and Fresnel in their trigonometric form.
pub fn fresnel(degrees: f64, eta: f64) -> f64 {
    let i = degrees.to_radians();
    if i == 0.0 {
        return ((eta - 1.0) / (eta + 1.0)).powi(2);
    }
    let t = (i.sin() / eta).asin();
    let s = (i - t).sin() / (i + t).sin();
    let p = (i - t).tan() / (i + t).tan();
    f64::midpoint(s * s, p * p)
}

/// The mean luminance of a picture.
pub fn mean_luminance(scene: &Scene, settings: RenderSettings) -> f64 {
    let settings = RenderSettings { bands_per_lane: 0, ..settings };
    let film = render(scene, &settings, &Progress::default()).unwrap().film;
    film.pixels.iter().map(|pixel| pixel.mean()[1]).sum::<f64>() / film.pixels.len() as f64
}

/// The mean luminance of square pictures of so many pixels a side, over eight seeds.
pub fn mean_over_seeds(scene: &Scene, side: u32, take: &Take) -> Estimate {
    let usual = RenderSettings { width: side, height: side, ..take.settings() };
    let of_seed = |seed| mean_luminance(scene, RenderSettings { seed, ..usual.clone() });
    Estimate::of((1..=8).map(of_seed).collect::<Vec<_>>().iter())
}
