// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Trial`]: a few walks from the eye that tell, before the picture, how its walks are to be spent.

use super::settings::RenderSettings;
use crate::math::DVec2;
use crate::sampling::PixelSequence;
use crate::scene::{Interior, Scene};
use crate::transport::{Eye, Gathered, Part, PathSettings, PathWalk, Photons, Tally};

/// Keeps the random numbers of trials apart from all others.
const TO_TRY: u64 = 0x3C6E_F372_FE94_F82B;
/// How many walks there are at most, one a pixel.
const WALKS: usize = 1 << 11;
/// The most splits of walks for sharp light, and how many segments a walk may have then, on average.
const MOST_SPLITS: u32 = 12;
const MOST_SEGMENTS: f64 = 64.0;

/// Walks through pixels that are spread evenly over the picture.
#[derive(Clone, Copy)]
pub(super) struct Trial<'a> {
    pub scene: &'a Scene,
    pub settings: &'a RenderSettings,
    pub interior: Interior,
}

impl Trial<'_> {
    /// How walks for sharp light are spent: with as many splits as their length lets.
    pub fn sharp(&self, path: PathSettings) -> PathSettings {
        let mut splits = MOST_SPLITS;
        while splits > path.split_depth {
            let own = path.of_sharp_light(splits);
            let (segments, _) = self.means(own, Part::Specular, None);
            if segments <= MOST_SEGMENTS {
                return own;
            }
            splits -= 2;
        }
        path
    }

    /// How many segments a walk has, and how many times it meets what landed, by what is sent on there.
    pub fn means(&self, path: PathSettings, part: Part, photons: Option<&Photons>) -> (f64, f64) {
        let Self { scene, settings, interior } = *self;
        let mut gathered = Gathered::new(0);
        let mut tally = Tally::new(scene.bodies.len());
        let pixels = settings.pixels() as usize;
        let (width, walks) = (settings.width as usize, WALKS.min(pixels));
        let mut met = 0.0;
        for walk in 0..walks {
            let pixel = walk * pixels / walks;
            let place = DVec2::new((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
            let sampler = PixelSequence::Sobol.sampler(settings.seed ^ TO_TRY, pixel as u64, 0);
            let wavelengths = sampler.wavelengths(scene.phases());
            let ray = scene.camera.ray(place, sampler.lens(), settings.width, settings.height);
            gathered.clear();
            let gathered = &mut gathered;
            let eye = Eye { gathered, part, guide: None, leaves_rough: false, photons };
            PathWalk::gather(scene, path, wavelengths, sampler, &mut tally, eye, (ray, interior));
            met += gathered.met.min(1.0);
        }
        let number = walks.max(1) as f64;
        (tally.segments() as f64 / number, met / number)
    }
}
