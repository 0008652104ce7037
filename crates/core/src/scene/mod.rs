// SPDX-License-Identifier: Apache-2.0 OR MIT
//! A scene: bodies, lights and background, the eye, and the questions a walk asks of them.

mod body;
mod builder;
mod camera;
mod contact;
mod crossing;
mod emission;
mod emitters;
mod interior;
mod world;

pub use body::{Body, BodyId};
pub use builder::{SceneBuilder, SceneError};
pub use camera::{Camera, CameraError, Projection};
pub use crossing::{Face, Place};
pub use emission::{Distribution, Emission, Strength};
pub use emitters::{EmitterSample, Emitters};
pub use interior::{Interior, LostRay};
pub use world::{Scene, SurfaceHit};
