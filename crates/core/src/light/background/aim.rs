// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Aim`]: where in the background it is worth to look.

use super::map::SphereMap;
use super::{Base, SkyModel, SoftBox, Sun};
use crate::math::{DMat3, DVec3, Ray};
use crate::spectrum::SpectralTable;

/// Columns and rows of the grid by which a sky with a sun in it is sampled: 2.8° each.
const SKY_PATCHES: [usize; 2] = [128, 64];

/// A choice among what is bright: soft boxes by the solid angle they fill, suns, and the places of
/// an uneven surround, each by its luminance × solid angle.
#[derive(Clone, Debug)]
pub(super) struct Aim {
    /// Luminance of each soft box, on average.
    box_luminance: Vec<f64>,
    /// Luminance × solid angle of each sun.
    sun_weight: Vec<f64>,
    base: Option<AimedBase>,
}

/// An uneven surround.
#[derive(Clone, Debug)]
struct AimedBase {
    map: SphereMap,
    to_map: DMat3,
}

/// One thing to aim at.
enum Target {
    Box(usize),
    Sun(usize),
    Base,
}

impl Aim {
    pub fn new(
        base: &Base,
        soft_boxes: &[SoftBox],
        suns: &[Sun],
        luminosity: &SpectralTable,
    ) -> Self {
        let luminance = |table: &SpectralTable| table.mean_dot(luminosity).max(0.0);
        let base = match base {
            Base::Constant(_) | Base::Gradient { .. } => None,
            Base::Sky(sky) => match sky.model {
                SkyModel::Overcast => None,
                SkyModel::General { .. } => {
                    let (zenith, ground) = (luminance(&sky.zenith), luminance(&sky.ground));
                    let at = |row: usize, column: usize| match SphereMap::middle(
                        SKY_PATCHES,
                        [row, column],
                    ) {
                        direction if direction.y < 0.0 => ground,
                        direction => zenith * sky.model.relative(direction).max(0.0),
                    };
                    SphereMap::new(SKY_PATCHES, at).map(|map| (map, DMat3::IDENTITY))
                }
            },
            Base::Image(image) => image.brightness(luminosity).map(|m| (m, image.to_picture())),
        };
        Self {
            box_luminance: soft_boxes
                .iter()
                .map(|soft_box| luminance(&soft_box.radiance) * soft_box.mean_brightness())
                .collect(),
            sun_weight: suns.iter().map(|s| luminance(&s.radiance) * s.solid_angle()).collect(),
            base: base.map(|(map, to_map)| AimedBase { map, to_map }),
        }
    }

    /// Every target with its weight as seen from `from`.
    fn targets<'a>(
        &'a self,
        soft_boxes: &'a [SoftBox],
        from: DVec3,
    ) -> impl Iterator<Item = (Target, f64)> + 'a {
        let boxes = soft_boxes.iter().zip(&self.box_luminance).enumerate();
        let boxes = boxes.map(move |(at, (soft_box, luminance))| {
            let weight =
                if *luminance > 0.0 { luminance * soft_box.apparent_size(from) } else { 0.0 };
            (Target::Box(at), weight)
        });
        let suns = self.sun_weight.iter().enumerate().map(|(at, w)| (Target::Sun(at), *w));
        boxes.chain(suns).chain(self.base.iter().map(|base| (Target::Base, base.map.total())))
    }

    /// Whether anything is seen from `from`.
    pub fn is_any_seen(&self, soft_boxes: &[SoftBox], from: DVec3) -> bool {
        self.targets(soft_boxes, from).any(|(_, weight)| weight > 0.0)
    }

    /// The sum of all weights as seen from `from`.
    fn weight(&self, soft_boxes: &[SoftBox], from: DVec3) -> f64 {
        self.targets(soft_boxes, from).map(|(_, weight)| weight).sum()
    }

    /// A direction from `from` for `u` uniform in the unit cube; `None` where nothing is seen.
    pub fn direction(
        &self,
        soft_boxes: &[SoftBox],
        suns: &[Sun],
        from: DVec3,
        [u, v, w]: [f64; 3],
    ) -> Option<DVec3> {
        let mut left = u * self.weight(soft_boxes, from);
        let mut chosen = None;
        for (target, weight) in self.targets(soft_boxes, from) {
            if weight > 0.0 {
                chosen = Some(target);
                if left < weight {
                    break;
                }
                left -= weight;
            }
        }
        match chosen? {
            Target::Box(at) => (soft_boxes[at].point([v, w]) - from).try_normalize(),
            Target::Sun(at) => Some(suns[at].direction([v, w])),
            Target::Base => {
                let base = self.base.as_ref()?;
                Some(base.to_map.transpose() * base.map.direction([v, w]))
            }
        }
    }

    /// The density of [`Self::direction`] at the origin of `ray` along it, per sr.
    pub fn density(&self, soft_boxes: &[SoftBox], suns: &[Sun], ray: &Ray) -> f64 {
        let (mut total, mut sum) = (0.0, 0.0);
        for (target, weight) in self.targets(soft_boxes, ray.origin) {
            if weight <= 0.0 {
                continue;
            }
            total += weight;
            sum += weight
                * match target {
                    Target::Box(at) => soft_boxes[at].density(ray),
                    Target::Sun(at) if suns[at].covers(ray.direction) => {
                        1.0 / suns[at].solid_angle()
                    }
                    Target::Sun(_) => 0.0,
                    Target::Base => self
                        .base
                        .as_ref()
                        .map_or(0.0, |base| base.map.density(base.to_map * ray.direction)),
                };
        }
        if total > 0.0 {
            sum / total
        } else {
            0.0
        }
    }
}
