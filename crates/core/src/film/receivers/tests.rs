// SPDX-License-Identifier: Apache-2.0 OR MIT
use std::f64::consts::{FRAC_PI_2, PI};

use super::*;

fn direction(h_deg: f64, v_deg: f64) -> DVec3 {
    let ((sin_h, cos_h), (sin_v, cos_v)) =
        (h_deg.to_radians().sin_cos(), v_deg.to_radians().sin_cos());
    DVec3::new(sin_h * cos_v, sin_v, cos_h * cos_v)
}

fn receivers(distance: Option<f64>) -> Receivers {
    Receivers {
        frame: DMat3::IDENTITY,
        centre: DVec3::ZERO,
        distance,
        cells: None,
        spots: Spots::default(),
        map: None,
        spot_bands: 0,
        cell_bands: 0,
    }
}

#[test]
fn every_direction_is_in_the_spots_that_are_no_farther_than_their_half_angle() {
    let degrees = |h: f64, v: f64, half: f64| Spot {
        h: h.to_radians(),
        v: v.to_radians(),
        // None of the directions below is on a border.
        half_angle: (half + 0.017).to_radians(),
    };
    let all = [
        degrees(0.0, 0.0, 0.25),
        degrees(-20.0, 5.0, 0.5),
        degrees(179.9, 0.0, 2.0),
        degrees(30.0, 89.0, 3.0),
        degrees(-90.0, -60.0, 10.0),
        degrees(10.0, 0.0, 89.95),
        degrees(0.1, 0.1, 0.2),
    ];
    let spots = Spots::new(&all);
    let mut met = [0; 7];
    for i in 0..360 {
        for j in 0..=180 {
            for fine in [0.0, 0.13, 0.37] {
                let (h, v) = (f64::from(i) - 180.0 + fine, (f64::from(j) - 90.0 + fine).min(90.0));
                let way = direction(h, v);
                let (h, v) = angles(way);
                let mut found: Vec<usize> = spots.around(way, h, v).collect();
                found.sort_unstable();
                let holds = |spot: &Spot| {
                    let middle = direction(spot.h.to_degrees(), spot.v.to_degrees());
                    middle.angle_between(way) <= spot.half_angle
                };
                let expected: Vec<usize> = (0..all.len()).filter(|at| holds(&all[*at])).collect();
                assert_eq!(found, expected, "{h} {v}");
                for at in found {
                    met[at] += 1;
                }
            }
        }
    }
    assert!(met.iter().all(|count| *count > 0), "{met:?}");
}

#[test]
fn a_cell_has_the_directions_between_its_borders_and_a_border_belongs_to_the_next() {
    let h = vec![-PI, -0.5, 0.0, 0.1, PI];
    let v = vec![-FRAC_PI_2, 0.0, 0.2, FRAC_PI_2];
    let cells = DirectionCells::new(h, v).unwrap();
    assert_eq!(cells.len(), 12);
    for (h, v, expected) in [
        (-0.2, -0.3, Some(1)),
        (0.0, 0.0, Some(4 + 2)),
        (0.05, 0.1, Some(4 + 2)),
        (PI, FRAC_PI_2, Some(8 + 3)),
        (-PI, -FRAC_PI_2, Some(0)),
    ] {
        assert_eq!(cells.find(h, v), expected, "{h} {v}");
    }
    let narrow = DirectionCells::new(vec![0.0, 0.1], vec![0.0, 0.1]).unwrap();
    assert_eq!(narrow.find(0.11, 0.05), None);
    for edges in [vec![0.0], vec![0.0, 0.0], vec![0.1, 0.0], vec![0.0, 4.0]] {
        assert!(DirectionCells::new(edges, vec![0.0, 0.1]).is_none());
    }
}

#[test]
fn a_near_receiver_sees_light_where_it_crosses_its_sphere() {
    let near = receivers(Some(100.0));
    // From 10 mm beside the centre, along the axis: met at asin 0.1 off the axis.
    let ray = Ray::endless(DVec3::new(10.0, 0.0, -3.0), DVec3::Z);
    let (h, v) = angles(near.direction(&ray).unwrap());
    assert!((h - 0.1_f64.asin()).abs() < 1e-12 && v.abs() < 1e-15);
    let far = receivers(None);
    assert_eq!(angles(far.direction(&ray).unwrap()), (0.0, 0.0));
    let beside = Ray::endless(DVec3::new(101.0, 0.0, 0.0), DVec3::Z);
    assert!(near.direction(&beside).is_none());
    let beyond = Ray::endless(DVec3::new(0.0, 0.0, 200.0), DVec3::Z);
    assert!(near.direction(&beyond).is_none());
    assert!(near.reach_round([DVec3::splat(-20.0), DVec3::splat(50.0)]));
    assert!(!near.reach_round([DVec3::splat(-60.0), DVec3::splat(50.0)]));
}

#[test]
fn a_map_counts_its_rows_from_the_top_and_its_front_alone() {
    let map = PlaneMap {
        centre: DVec3::new(0.0, 0.0, 50.0),
        half_width: DVec3::X * -30.0,
        half_height: DVec3::Y * 20.0,
        size: [3, 2],
    };
    assert!((map.pixel_area() - 400.0e-6).abs() < 1e-15);
    let met = |x: f64, y: f64| map.pixel(&Ray::endless(DVec3::new(x, y, 0.0), DVec3::Z));
    // Its normal is −z; seen from there its right is −x.
    assert_eq!(met(-25.0, 15.0), Some(2));
    assert_eq!(met(25.0, -15.0), Some(3));
    assert_eq!(met(31.0, 0.0), None);
    let from_behind = Ray::endless(DVec3::Z * 100.0, -DVec3::Z);
    assert_eq!(map.pixel(&from_behind), None);
}

#[test]
fn bands_follow_each_other_by_wavelength() {
    // λ rises by (lane · phases + phase); each lane's phases are cut into five bands.
    let (phases, per_lane) = (25, 5);
    for lane in 0..LANES {
        for phase in 0..phases {
            let mut flux = SampledSpectrum::ZERO;
            flux.0[lane] = 2.0;
            let mut bands = vec![0.0; 2 * per_lane * LANES];
            add_bands(&mut bands, 1, per_lane, flux, (phase, phases));
            let number = (lane * phases + phase) / (phases / per_lane);
            let expected = per_lane * LANES + number;
            assert_eq!(bands.iter().position(|value| *value == 2.0), Some(expected));
            assert_eq!(bands.iter().sum::<f64>(), 2.0);
        }
    }
}
