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
/// The splits of walks for sharp light that are tried, and how many segments a walk may have then, on average.
const SPLITS: [u32; 3] = [12, 8, 4];
const MOST_SEGMENTS: u64 = 64;

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
        let is_short = |own: &PathSettings| {
            let mut walks = 0;
            self.walk(*own, Part::Specular, None, |_, segments| {
                walks += 1;
                segments <= MOST_SEGMENTS * self.walks() as u64
            });
            walks == self.walks()
        };
        SPLITS.map(|splits| path.of_sharp_light(splits)).into_iter().find(is_short).unwrap_or(path)
    }

    /// How many times a walk meets what landed, by what is sent on there.
    pub fn meetings(&self, path: PathSettings) -> f64 {
        let mut met = 0.0;
        self.walk(path, Part::Scattered, Some(&Photons::none()), |gathered, _| {
            met += gathered.met.min(1.0);
            true
        });
        met / self.walks() as f64
    }

    fn walks(&self) -> usize {
        WALKS.min(self.settings.pixels() as usize).max(1)
    }

    /// Walk until `goes_on`, which is shown what each walk brought and the segments of all so far, says no.
    fn walk(
        &self,
        path: PathSettings,
        part: Part,
        photons: Option<&Photons>,
        mut goes_on: impl FnMut(&Gathered, u64) -> bool,
    ) {
        let Self { scene, settings, interior } = *self;
        let mut gathered = Gathered::new(0);
        let mut tally = Tally::new(scene.bodies.len());
        let pixels = settings.pixels() as usize;
        let (width, walks) = (settings.width as usize, self.walks());
        for walk in 0..walks {
            let pixel = walk * pixels / walks;
            let place = DVec2::new((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5);
            let sampler = PixelSequence::Sobol.sampler(settings.seed ^ TO_TRY, pixel as u64, 0);
            let wavelengths = sampler.wavelengths(scene.phases());
            let ray = scene.camera.ray(place, sampler.lens(), settings.width, settings.height);
            gathered.clear();
            let eye = Eye { gathered: &mut gathered, part, guide: None, photons };
            PathWalk::gather(scene, path, wavelengths, sampler, &mut tally, eye, (ray, interior));
            if !goes_on(&gathered, tally.segments()) {
                break;
            }
        }
    }
}
