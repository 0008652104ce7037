// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Unbiased spectral path transport: the rendering equation, walked from the eye or from a light.
//!
//! Per lane, the basic radiance L/n² that arrives at the eye along a ray of length s is
//!
//!   L = T(s)·[ `L_e` + ∫ f L |cos θ| dω ] + ∫₀ˢ T(t)·`σ_s`·∫ p L dω dt
//!
//! with T(t) the transmittance of the way, exact; `L_e` what the surface at its end (or the
//! background) sends out; f the surface's answer, and p the phase function of a scattering body.
//! A [`Branch`] carries the product of all factors so far; each step of [`PathWalk::follow`] is one
//! term. Integrals are sampled; the two ways on at a smooth surface are a sum, and are both followed
//! while that matters to the pixel.
//!
//! A walk from a light goes the same ways by the same rules, and carries flux: a surface's answer
//! keeps energy, and n(wi)² f(wi, wo) = n(wo)² f(wo, wi), so that the share of the radiance from wo
//! that goes to wi is also the share of the flux from wi that goes to wo. What differs is where it
//! starts, and that it looks for nothing: what leaves the scene, and where it arrives, is handed on ([`Purpose`]).
//!
//! Source: J. Kajiya, "The Rendering Equation", SIGGRAPH 1986; E. Veach, *Robust Monte Carlo
//! Methods for Light Transport Simulation*, 1997 (multiple importance sampling, ch. 9; roulette and
//! splitting, ch. 10); A. Wilkie et al., "Hero Wavelength Spectral Sampling", EGSR 2014.

mod branch;
mod direct;
mod interface;
mod landing;
mod medium;
mod purpose;
mod turning;
mod vertex;

use crate::math::Ray;
use crate::sampling::PixelSampler;
use crate::scene::{BodyId, Face, Interior, LostRay, Scene};
use crate::spectrum::{SampledSpectrum, SampledWavelengths};

use super::meeting::Meeting;
use super::tally::Tally;
use branch::{Branch, Ways};
use medium::Scattered;
use purpose::Purpose;
use vertex::Vertex;

pub use purpose::{Carried, Eye, Part, Receive};

/// How the walks are spent. None of these changes what the picture tends to, but `max_depth`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSettings {
    /// How many surfaces and scatterings one walk may meet.
    pub max_depth: u32,
    /// How many times both ways on at a surface are followed, from the eye on; at the first rough one always.
    pub split_depth: u32,
    /// A branch that carries less than this share of the visible light is followed by chance only.
    pub roulette_below: f64,
}

impl PathSettings {
    /// How walks are spent that bring what is seen in mirrors and through smooth glass alone. An image
    /// of a light after two faint mirrorings is followed always and weighs little, not rarely and as a dot;
    /// splits are bounded, since a walk in many panes would have no end.
    #[must_use]
    pub fn of_sharp_light(self, splits: u32) -> Self {
        Self {
            split_depth: self.split_depth.max(splits),
            roulette_below: self.roulette_below.min(1e-3),
            ..self
        }
    }

    /// How walks from lights are spent that serve a picture from the eye: docs/transport.md has what was
    /// measured.
    #[must_use]
    pub fn from_lights(self) -> Self {
        Self { split_depth: 1, roulette_below: 0.25, ..self }
    }
}

/// One sample's tree of rays.
pub struct PathWalk<'a> {
    scene: &'a Scene,
    settings: PathSettings,
    wavelengths: SampledWavelengths,
    /// How much each lane matters to the eye: the sum of its colour-matching functions; together 1.
    visibility: SampledSpectrum,
    /// How much of a lane's throughput the ledger books.
    booked: SampledSpectrum,
    tally: &'a mut Tally,
    purpose: Purpose<'a>,
    pending: Vec<Branch>,
}

/// What a branch comes to.
enum Event {
    /// It leaves the scene.
    Escape,
    /// It is lost, and counted.
    Lost,
    /// It is scattered inside a body.
    Scattering(Scattered),
    /// It meets opaque matter.
    Surface(Meeting),
    /// It meets the boundary between two transparent media.
    Interface(Meeting, Face, Interior),
}

impl<'a> PathWalk<'a> {
    /// Gather the light that arrives at the eye against `ray`, which starts in `interior`.
    pub fn gather(
        scene: &'a Scene,
        settings: PathSettings,
        wavelengths: SampledWavelengths,
        sampler: PixelSampler,
        tally: &'a mut Tally,
        eye: Eye<'a>,
        start: (Ray, Interior),
    ) {
        let visibility = scene.visibility.at(wavelengths);
        let (booked, pending) = (visibility, vec![Branch::from_eye(start, sampler)]);
        let purpose = Purpose::Eye(eye);
        Self { scene, settings, wavelengths, visibility, booked, tally, purpose, pending }.run();
    }

    /// Carry `flux` from where `start` begins, and show where it arrives and leaves. The weights of
    /// roulette are those of `flux`; `booked` is how much of each lane the ledger books.
    #[expect(clippy::too_many_arguments, reason = "as the walk from the eye, and what it carries")]
    pub fn carry(
        scene: &'a Scene,
        settings: PathSettings,
        wavelengths: SampledWavelengths,
        sampler: PixelSampler,
        tally: &'a mut Tally,
        receive: &'a mut Receive<'a>,
        start: (Ray, Interior),
        (flux, booked): (SampledSpectrum, SampledSpectrum),
    ) {
        let visibility = scene.visibility.at(wavelengths);
        let pending = vec![Branch { throughput: flux, ..Branch::from_eye(start, sampler) }];
        let purpose = Purpose::Light(receive);
        Self { scene, settings, wavelengths, visibility, booked, tally, purpose, pending }.run();
    }

    fn run(mut self) {
        let started = self.pending.iter().map(|branch| self.worth(branch.throughput)).sum();
        self.tally.ledger.start(started);
        while let Some(mut branch) = self.pending.pop() {
            while self.step(&mut branch) {}
        }
    }

    /// One segment, and the light and the ways on at its end; whether the branch goes on.
    fn step(&mut self, branch: &mut Branch) -> bool {
        let event = self.next_event(branch);
        let before = self.worth(branch.throughput);
        match event {
            Event::Lost => false,
            Event::Escape => {
                self.leave(branch);
                self.tally.ledger.escape(before);
                false
            }
            Event::Scattering(at) => {
                let wi = -branch.ray.direction;
                let vertex = Vertex::in_body(at.position, wi, at.anisotropy, branch.interior);
                let ways = self.scatter(branch, &vertex);
                self.go_on(branch, &ways, before, None)
            }
            Event::Surface(meeting) => {
                self.see_emission(branch, &meeting);
                let ways = self.answer(branch, &meeting);
                self.go_on(branch, &ways, before, Some(meeting.hit.body))
            }
            Event::Interface(meeting, face, beyond) => {
                let ways = self.cross(branch, &meeting, face, &beyond);
                self.go_on(branch, &ways, before, None)
            }
        }
    }

    /// Follow a branch to what it meets next, through all surfaces that are none to light.
    fn next_event(&mut self, branch: &mut Branch) -> Event {
        loop {
            self.tally.eye_rays += 1;
            let place = self.scene.first_place(&branch.ray);
            let length = place.as_ref().map_or(f64::INFINITY, |place| place.hit.point.t);
            let before = branch.way;
            branch.way += length;
            if let Some(body) = branch.interior.filling(&self.scene.bodies) {
                if place.is_none() {
                    return self.lose(branch, body, LostRay::EndedInside);
                }
                if let Some(at) = self.pass_through(branch, body, length) {
                    branch.way = before + at.distance;
                    return Event::Scattering(at);
                }
            }
            let Some(place) = place else {
                return Event::Escape;
            };
            let hit = place.hit;
            if self.scene.material_of(hit.body).dielectric().is_none() {
                return Event::Surface(Meeting::new(hit, branch.ray.direction));
            }
            let mut lost = None;
            let beyond = branch.interior.through(place.faces(), |body, cause| {
                self.tally.lose(body, cause);
                lost = Some(body);
            });
            if let Some(face) = self.boundary(&branch.interior, &beyond) {
                let meeting = Meeting::new(hit, branch.ray.direction);
                return Event::Interface(meeting, face, beyond);
            }
            branch.interior = beyond;
            branch.ray.origin = hit.point.leave_along(branch.ray.direction);
            // So that no defect makes an endless walk.
            branch.depth += u32::from(lost.is_some());
            if branch.depth > self.settings.max_depth {
                self.tally.ledger.lose(self.worth(branch.throughput));
                return Event::Lost;
            }
        }
    }

    /// The face at which light turns: where matter changes, unless its index is the same on all lanes.
    fn boundary(&self, here: &Interior, beyond: &Interior) -> Option<Face> {
        let face = self.scene.reversible_interface(here, beyond)?;
        (self.index(here) != self.index(beyond)).then_some(face)
    }

    fn lose(&mut self, branch: &Branch, body: BodyId, cause: LostRay) -> Event {
        self.tally.lose(body, cause);
        self.tally.ledger.lose(self.worth(branch.throughput));
        Event::Lost
    }

    /// Whether the branch goes on, and book what stayed in `body` (or in the choices at random).
    fn go_on(
        &mut self,
        branch: &mut Branch,
        ways: &Ways,
        before: f64,
        body: Option<BodyId>,
    ) -> bool {
        let (worth, lives) = if ways.goes_on { self.enter(branch) } else { (0.0, false) };
        let after = worth + ways.parted;
        match body {
            Some(body) => self.tally.ledger.absorb(body, before, after),
            None => self.tally.ledger.chance(before, after),
        }
        lives
    }

    /// Let a branch that parted wait; what the ledger books of it.
    fn wait(&mut self, mut branch: Branch) -> f64 {
        let (worth, lives) = self.enter(&mut branch);
        if lives {
            self.pending.push(branch);
        }
        worth
    }

    /// What the ledger books of a branch that turned, and whether it is followed.
    fn enter(&mut self, branch: &mut Branch) -> (f64, bool) {
        let weight = self.weight(branch.throughput);
        if weight <= 0.0 {
            return (0.0, false);
        }
        let worth = self.worth(branch.throughput);
        branch.depth += 1;
        if branch.depth > self.settings.max_depth {
            self.tally.cut_by_depth += 1;
            self.tally.ledger.cut(worth);
            return (worth, false);
        }
        (worth, self.survives(branch, weight))
    }

    /// Russian roulette: end a branch of little weight, or make it stand for those that ended.
    fn survives(&mut self, branch: &mut Branch, weight: f64) -> bool {
        let chance = weight * branch.promise / self.settings.roulette_below;
        if chance >= 1.0 {
            return true;
        }
        let [u, ..] = branch.sampler.next_4d();
        let lives = u < chance;
        let worth = self.worth(branch.throughput);
        self.tally.ledger.chance(worth, if lives { worth / chance } else { 0.0 });
        branch.throughput *= 1.0 / chance;
        lives
    }

    /// Which of two ways on, that carry about `shares` of the throughput, are followed: both while
    /// that matters, else one, by chance in proportion to what the eye gets of it, in the place of
    /// both.
    fn divide(&self, branch: &mut Branch, shares: [&SampledSpectrum; 2], u: f64) -> [bool; 2] {
        let [first, second] = shares.map(|share| self.weight(branch.throughput * *share));
        if branch.splits < self.settings.split_depth && first.min(second) > 0.0 {
            branch.splits += 1;
            return [true, true];
        }
        let probability = first / (first + second);
        if u < probability {
            branch.throughput *= 1.0 / probability;
            [true, false]
        } else if second > 0.0 {
            branch.throughput *= 1.0 / (1.0 - probability);
            [false, true]
        } else {
            [false, false]
        }
    }

    /// The share of the light that the eye sees of what a throughput carries.
    fn weight(&self, throughput: SampledSpectrum) -> f64 {
        throughput.dot(self.visibility)
    }

    /// What the ledger books of a throughput.
    fn worth(&self, throughput: SampledSpectrum) -> f64 {
        throughput.dot(self.booked)
    }

    /// How probable each lane is to be chosen, by what the eye gets of it; together 1.
    fn lanes(&self, throughput: SampledSpectrum) -> SampledSpectrum {
        let seen = throughput * self.visibility;
        seen * (1.0 / throughput.dot(self.visibility))
    }
}

/// The lane that `u` chooses from probabilities that add up to 1.
fn pick(lanes: &SampledSpectrum, u: f64) -> usize {
    let mut sum = 0.0;
    let last = lanes.0.iter().rposition(|c| *c > 0.0).unwrap_or(0);
    lanes.0[..last]
        .iter()
        .position(|c| {
            sum += c;
            u < sum
        })
        .unwrap_or(last)
}
