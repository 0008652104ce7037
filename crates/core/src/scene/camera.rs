// SPDX-License-Identifier: Apache-2.0 OR MIT
//! [`Camera`]: the eye.

use thiserror::Error;

use crate::math::{DVec2, DVec3, Ray};
use crate::sampling::uniform_disc;

/// How the eye sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Through one point.
    Pinhole {
        /// The full vertical angle of the image, in degrees.
        field_of_view_deg: f64,
    },
    /// Through a round lens without thickness that brings one plane into focus.
    ThinLens {
        /// The full vertical angle of the image, in degrees.
        field_of_view_deg: f64,
        /// The diameter of the lens, in mm.
        aperture: f64,
        /// How far in front of the lens the plane in focus is, in mm.
        focus: f64,
    },
    /// By parallel rays.
    Orthographic {
        /// The height of what the image shows, in mm.
        height: f64,
    },
}

/// Why a camera cannot see.
#[derive(Debug, Error, PartialEq)]
pub enum CameraError {
    /// Position and target are the same point, or `up` lies along the view.
    #[error(
        "the camera needs a target away from its position and an up that is not along its view"
    )]
    NoView,
    /// The projection's number is out of range.
    #[error("a field of view lies between 0 and 180 degrees; image height, aperture and focus above 0 mm")]
    Projection,
}

/// The eye: where it is, where it looks, and how wide.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    position: DVec3,
    forward: DVec3,
    /// Half the image's height as a vector at unit distance (pinhole) or in mm (orthographic).
    half_up: DVec3,
    right: DVec3,
    projection: Projection,
}

impl Camera {
    /// A camera at `position` that looks at `target`, with `up` upwards in the image.
    ///
    /// # Errors
    /// The view has no direction, or the projection's number is out of range.
    pub fn new(
        position: DVec3,
        target: DVec3,
        up: DVec3,
        projection: Projection,
    ) -> Result<Self, CameraError> {
        let forward = (target - position).try_normalize().ok_or(CameraError::NoView)?;
        let across = forward.cross(up.normalize_or_zero());
        if across.length() < 1e-9 {
            return Err(CameraError::NoView);
        }
        let right = across.normalize();
        let half_height = match projection {
            Projection::Pinhole { field_of_view_deg: fov } if is_angle(fov) => half_tangent(fov),
            Projection::ThinLens { field_of_view_deg: fov, aperture, focus }
                if is_angle(fov) && is_length(aperture) && is_length(focus) =>
            {
                half_tangent(fov)
            }
            Projection::Orthographic { height } if is_length(height) => height / 2.0,
            _ => return Err(CameraError::Projection),
        };
        let half_up = right.cross(forward) * half_height;
        Ok(Self { position, forward, half_up, right: right * half_height, projection })
    }

    /// Where the camera is.
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// The ray through a place of the image, in pixels from its upper left corner, and through the
    /// point `u` (uniform in the unit square) of the lens, if there is one.
    pub fn ray(&self, place: DVec2, u: DVec2, width: u32, height: u32) -> Ray {
        let half = f64::from(height) / 2.0;
        let x = (place.x - f64::from(width) / 2.0) / half;
        let y = 1.0 - place.y / half;
        let aside = self.right * x + self.half_up * y;
        match self.projection {
            Projection::Pinhole { .. } => {
                Ray::endless(self.position, (self.forward + aside).normalize())
            }
            Projection::ThinLens { aperture, focus, .. } => {
                let [x, y] = uniform_disc([u.x, u.y]);
                let on_lens = self.right.normalize() * x + self.half_up.normalize() * y;
                let across = on_lens * (aperture / 2.0);
                let in_focus = (self.forward + aside) * focus;
                Ray::endless(self.position + across, (in_focus - across).normalize())
            }
            Projection::Orthographic { .. } => Ray::endless(self.position + aside, self.forward),
        }
    }
}

impl Camera {
    /// How wide one of the pixels of so many rows is, in mm, at a `distance` straight ahead.
    pub fn pixel_mm(&self, distance: f64, rows: u32) -> f64 {
        let side = 2.0 * self.half_up.length() / f64::from(rows);
        match self.projection {
            Projection::Orthographic { .. } => side,
            Projection::Pinhole { .. } | Projection::ThinLens { .. } => side * distance,
        }
    }
}

fn is_angle(field_of_view_deg: f64) -> bool {
    field_of_view_deg > 0.0 && field_of_view_deg < 180.0
}

fn is_length(length: f64) -> bool {
    length > 0.0 && length.is_finite()
}

fn half_tangent(field_of_view_deg: f64) -> f64 {
    (field_of_view_deg / 2.0).to_radians().tan()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_image_has_x_to_the_right_y_down_and_spans_the_vertical_field_of_view() {
        let projection = Projection::Pinhole { field_of_view_deg: 90.0 };
        let camera = Camera::new(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y, projection).unwrap();
        let centre = camera.ray(DVec2::new(200.0, 100.0), DVec2::ZERO, 400, 200);
        assert!((centre.direction + DVec3::Z).length() < 1e-15);
        let top = camera.ray(DVec2::new(200.0, 0.0), DVec2::ZERO, 400, 200).direction;
        assert!((top - DVec3::new(0.0, 1.0, -1.0).normalize()).length() < 1e-15);
        let right = camera.ray(DVec2::new(400.0, 100.0), DVec2::ZERO, 400, 200).direction;
        assert!((right - DVec3::new(2.0, 0.0, -1.0).normalize()).length() < 1e-15);
    }

    #[test]
    fn parallel_rays_start_across_the_given_height() {
        let projection = Projection::Orthographic { height: 20.0 };
        let camera = Camera::new(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y, projection).unwrap();
        let top = camera.ray(DVec2::new(50.0, 0.0), DVec2::ZERO, 100, 100);
        assert!((top.origin - DVec3::new(0.0, 10.0, 5.0)).length() < 1e-14);
        assert!((top.direction + DVec3::Z).length() < 1e-15);
    }

    #[test]
    fn all_rays_of_a_lens_meet_in_the_plane_in_focus_and_fill_the_aperture() {
        let projection =
            Projection::ThinLens { field_of_view_deg: 40.0, aperture: 6.0, focus: 50.0 };
        let camera = Camera::new(DVec3::Z * 5.0, DVec3::ZERO, DVec3::Y, projection).unwrap();
        let place = DVec2::new(320.0, 20.0);
        let through = |u: DVec2| camera.ray(place, u, 400, 200);
        let in_focus = |ray: Ray| ray.at((-45.0 - ray.origin.z) / ray.direction.z);
        let middle = in_focus(through(DVec2::splat(0.5)));
        let mut widest = 0.0_f64;
        for i in 0..64 {
            let ray = through(DVec2::new(f64::from(i % 8) / 7.0, f64::from(i / 8) / 7.0));
            assert!(in_focus(ray).distance(middle) < 1e-12);
            widest = widest.max(ray.origin.distance(DVec3::Z * 5.0));
        }
        assert!((widest - 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_camera_without_a_view_is_refused() {
        let projection = Projection::Pinhole { field_of_view_deg: 30.0 };
        let at_itself = Camera::new(DVec3::ONE, DVec3::ONE, DVec3::Y, projection);
        assert_eq!(at_itself.unwrap_err(), CameraError::NoView);
        let along_up = Camera::new(DVec3::Y, DVec3::ZERO, DVec3::Y, projection);
        assert_eq!(along_up.unwrap_err(), CameraError::NoView);
        let wide = Projection::Pinhole { field_of_view_deg: 180.0 };
        let too_wide = Camera::new(DVec3::Z, DVec3::ZERO, DVec3::Y, wide);
        assert_eq!(too_wide.unwrap_err(), CameraError::Projection);
    }
}
