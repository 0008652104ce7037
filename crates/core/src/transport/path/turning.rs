// SPDX-License-Identifier: Apache-2.0 OR MIT
//! How a branch is turned at random: as the surface answers, and towards what is bright.
//!
//! Where one way is followed, its direction is drawn from one mixture: mostly as the surface answers,
//! sometimes towards what stands out in the background or is known to shine. At the first turn, and later
//! while both ways on are followed, aimed ways go besides and not in the place of others, and one goes to
//! each side of a boundary, as its facets mirror and refract: what is mirrored is little and often bright.
//! Every way is divided by the sum of the densities of all that could have drawn it: the balance heuristic.

use std::f64::consts::PI;

use crate::math::{DVec3, Ray};
use crate::spectrum::SampledSpectrum;
use crate::transport::guide::Answered;

use super::branch::{Branch, CameBy, Seeks, Ways};
use super::purpose::Purpose;
use super::vertex::Vertex;
use super::PathWalk;

/// How often a direction is drawn towards learned light, where there is some.
const GUIDED: f64 = 0.5;

/// How many times both ways on are followed by what was drawn so.
const AIMED_SPLITS: u32 = 1;

/// How often directions are drawn towards learned light, and towards a bright background.
pub(super) struct Aims<'a> {
    background: f64,
    guided: f64,
    light: Option<Answered<'a>>,
    /// Whether these are drawn besides one for each side, and not in the place of others.
    follows_all: bool,
}

/// What draws a direction.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Technique {
    /// The surface, as it answers.
    Surface,
    /// The same, to the near or the far side of a boundary.
    Side { is_near: bool },
    /// What stands out in the background.
    Background,
    /// What is known of lights.
    Guide,
}

/// How densely a direction is drawn, per steradian.
pub(super) struct Densities {
    /// By the surface alone.
    own: f64,
    /// In all.
    pub all: f64,
}

/// Where a branch is turned.
struct Turn<'a> {
    vertex: &'a Vertex<'a>,
    lanes: SampledSpectrum,
    aims: Aims<'a>,
    /// Whether it has met light there.
    is_met: bool,
    /// Whether all light was left to others before.
    was_left: bool,
}

impl Aims<'_> {
    const NONE: Self = Self { background: 0.0, guided: 0.0, light: None, follows_all: false };

    /// The one technique that `u` chooses.
    fn choose(&self, u: f64) -> Technique {
        if u < self.background {
            Technique::Background
        } else if u < self.background + self.guided {
            Technique::Guide
        } else {
            Technique::Surface
        }
    }
}

impl<'a> PathWalk<'a> {
    /// Turn a branch at a vertex, if it goes on: ∫ f L |cos θ| dω by a few directions and one look at
    /// the emitters.
    pub(super) fn scatter(&mut self, branch: &mut Branch, vertex: &Vertex<'_>) -> Ways {
        if !self.purpose.scatters() {
            return Ways::default();
        }
        let lanes = self.lanes(branch.throughput);
        let ground = vertex.ground();
        let meets_again = branch.rivals > 0.0 && ground.is_some();
        if !meets_again && !self.widens(branch) {
            return Ways::default();
        }
        let was_left = Self::all_is_left(branch);
        self.land(branch, vertex, ground.as_ref());
        let is_met = ground.as_ref().is_some_and(|ground| match self.purpose {
            Purpose::Eye(_) => self.meet(branch, vertex, ground),
            Purpose::Light(_) => true,
        });
        branch.has_turned = true;
        let aims = self.aims(branch, vertex, &lanes);
        self.see_emitters(branch, vertex, &lanes, &aims);
        branch.way = 0.0;
        branch.scatterings += 1;
        let turn = Turn { vertex, lanes, aims, is_met, was_left };
        let [choice, rest @ ..] = branch.sampler.next_4d();
        if !turn.aims.follows_all {
            let technique = turn.aims.choose(choice);
            return Ways::one(self.turn(branch, &turn, technique, rest));
        }
        branch.splits += 1;
        let Aims { background, guided, .. } = turn.aims;
        let mut parted = 0.0;
        let aimed =
            [(Technique::Background, choice < background), (Technique::Guide, rest[0] < guided)];
        for (technique, _) in aimed.into_iter().filter(|(_, is_followed)| *is_followed) {
            let mut other = branch.part();
            let [u, v, w, _] = other.sampler.next_4d();
            if self.turn(&mut other, &turn, technique, [u, v, w]) {
                parted += self.wait(other);
            }
        }
        let [u, v, w, _] = branch.sampler.next_4d();
        let mut last = Technique::Surface;
        if vertex.is_boundary {
            // The same facet mirrors and refracts: in even light both together have no noise.
            let mut other = branch.part();
            if self.turn(&mut other, &turn, Technique::Side { is_near: true }, [u, v, w]) {
                parted += self.wait(other);
            }
            last = Technique::Side { is_near: false };
        }
        Ways { goes_on: self.turn(branch, &turn, last, [u, v, w]), parted }
    }

    /// Give a branch a direction; whether it goes on.
    fn turn(
        &self,
        branch: &mut Branch,
        turn: &Turn<'_>,
        technique: Technique,
        u: [f64; 3],
    ) -> bool {
        let Turn { vertex, lanes, aims, .. } = turn;
        let drawn = match technique {
            Technique::Surface => vertex.sample(lanes, u),
            Technique::Side { is_near } => vertex.sample_side(is_near, lanes, u),
            Technique::Background => self.scene.background.aim(vertex.position, u),
            Technique::Guide => aims.light.as_ref().map(|light| light.sample(u)),
        };
        let Some(mut wo) = drawn else {
            return false;
        };
        let Densities { own, all: pdf } = self.densities(vertex, wo, lanes, aims);
        if technique == Technique::Guide {
            // What it was aimed at may be a mirror image: both ways on count there.
            branch.splits =
                branch.splits.min(self.settings.split_depth.saturating_sub(AIMED_SPLITS));
        }
        branch.came_by = CameBy::Scattering { from: vertex.position, pdf };
        branch.promise = (pdf / own).min(pdf * 4.0 * PI).max(1.0);
        let answer = vertex.answer(wo);
        branch.throughput *= answer * (1.0 / pdf);
        if turn.is_met {
            self.leave_ground(branch, vertex, wo, answer);
        }
        if !turn.was_left && Self::all_is_left(branch) && !self.survives_unseen(branch) {
            return false;
        }
        if !vertex.agrees(wo) {
            wo = vertex.put_right(wo);
            branch.came_by = CameBy::OneWay;
        }
        let (origin, interior) = vertex.leave_along(wo);
        branch.ray = Ray::endless(origin, wo);
        branch.interior = interior;
        pdf > 0.0
    }

    /// Whether all that a branch meets of emitters is left to walks from lights.
    fn all_is_left(branch: &Branch) -> bool {
        branch.is_left() && branch.rivals <= 0.0
    }

    /// Whether a branch goes on that is reflected or turned at random: a narrow one leaves emitters to
    /// others from there on.
    pub(super) fn widens(&self, branch: &mut Branch) -> bool {
        let was_left = Self::all_is_left(branch);
        branch.rivals = 0.0;
        if branch.seeks == Seeks::Refracted {
            branch.seeks = Seeks::Nothing;
        }
        was_left || !Self::all_is_left(branch) || self.survives_unseen(branch)
    }

    /// Whether a branch goes on whose emitters are left to others. Under a dark background it brings no
    /// light, and a few of them stand for all: for the ledger.
    fn survives_unseen(&self, branch: &mut Branch) -> bool {
        const FEW: f64 = 1.0 / 16.0;
        if !self.scene.background.is_dark() {
            return true;
        }
        let [u, ..] = branch.sampler.next_4d();
        branch.throughput *= 1.0 / FEW;
        u < FEW
    }

    /// How `scatter` aims. What is not aimed weighs more by 1/(1 − share) at each turn: so that after many
    /// turns a few walks do not carry all the light, the share halves with each.
    fn aims(&self, branch: &Branch, vertex: &Vertex<'_>, lanes: &SampledSpectrum) -> Aims<'a> {
        if !self.purpose.looks_for_light() {
            return Aims::NONE;
        }
        let share = 0.5_f64.powi(branch.scatterings as i32);
        let background = share * self.scene.background.aim_share(vertex.position);
        let splits = branch.scatterings == 0 || branch.splits < self.settings.split_depth;
        let follows_all = splits && !vertex.is_in_body();
        let guide = self.purpose.guide().filter(|_| !branch.is_left());
        let region = guide.and_then(|guide| guide.at(vertex.position));
        let Some(region) = region else {
            return Aims { background, follows_all, ..Aims::NONE };
        };
        let light = Some(region.answered(vertex.position, |wo| vertex.pdf(wo, lanes)));
        let guided = share * GUIDED;
        if follows_all {
            return Aims { background, guided, light, follows_all };
        }
        // Where both are sure of a half, each of the three ways of drawing has a third.
        let [background, guided] =
            [(background, guided), (guided, background)].map(|(a, b)| a * (1.0 - b * 2.0 / 3.0));
        Aims { background, guided, light, follows_all }
    }

    /// The densities of a direction that `scatter` may draw.
    pub(super) fn densities(
        &self,
        vertex: &Vertex<'_>,
        wo: DVec3,
        lanes: &SampledSpectrum,
        aims: &Aims<'_>,
    ) -> Densities {
        let own = if aims.follows_all && vertex.is_boundary {
            vertex.pdf_of_side(wo, lanes)
        } else {
            vertex.pdf(wo, lanes)
        };
        let replaced = if aims.follows_all { 0.0 } else { own };
        let mut all = own;
        if let Some(light) = &aims.light {
            all += aims.guided * (light.pdf(wo) - replaced);
        }
        if aims.background > 0.0 {
            let ray = Ray::endless(vertex.position, wo);
            all += aims.background * (self.scene.background.aim_pdf(&ray) - replaced);
        }
        Densities { own, all }
    }
}
