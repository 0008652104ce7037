// SPDX-License-Identifier: Apache-2.0 OR MIT

use std::collections::HashMap;
use std::f64::consts::PI;

use super::*;

type Mesh = (Vec<[f64; 3]>, Vec<[u32; 3]>);

/// Marsaglia's 64-bit xorshift.
struct Random(u64);

impl Random {
    /// Uniform in −1..1.
    fn signed(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let vector = self.vector();
            if (1e-4..1.0).contains(&vector.length_squared()) {
                return vector.normalize();
            }
        }
    }
}

fn ray(origin: DVec3, direction: DVec3) -> Ray {
    Ray { origin, direction, t_max: f64::INFINITY }
}

fn towards(origin: DVec3, target: DVec3) -> Ray {
    ray(origin, (target - origin).normalize())
}

fn build((vertices, triangles): &Mesh) -> Triangles {
    Triangles::build(vertices, triangles).unwrap()
}

/// Scaled, then moved along all axes.
fn placed((vertices, triangles): Mesh, scale: f64, offset: f64) -> Mesh {
    let place = |vertex: [f64; 3]| vertex.map(|x| x * scale + offset);
    (vertices.into_iter().map(place).collect(), triangles)
}

/// A unit sphere of 20 · 4ⁿ triangles.
fn icosphere(subdivisions: usize) -> Mesh {
    let g = f64::midpoint(1.0, 5.0_f64.sqrt());
    let mut points = Vec::new();
    for (a, b) in [(1.0, g), (1.0, -g), (-1.0, g), (-1.0, -g)] {
        points.extend([DVec3::new(0.0, a, b), DVec3::new(a, b, 0.0), DVec3::new(b, 0.0, a)]);
    }
    let edge = 2.0 + 1e-9;
    let near = |i: usize, j: usize| points[i].distance(points[j]) < edge;
    let mut faces: Vec<[u32; 3]> = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(i, j) && near(j, k) && near(i, k) {
                    let outward =
                        (points[j] - points[i]).cross(points[k] - points[i]).dot(points[i]) > 0.0;
                    let [j, k] = if outward { [j, k] } else { [k, j] };
                    faces.push([i as u32, j as u32, k as u32]);
                }
            }
        }
    }
    for _ in 0..subdivisions {
        let mut middles = HashMap::new();
        let mut middle = |i: u32, j: u32| {
            *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                points.push(points[i as usize] + points[j as usize]);
                points.len() as u32 - 1
            })
        };
        let mut finer = Vec::new();
        for [i, j, k] in faces {
            let [a, b, c] = [middle(i, j), middle(j, k), middle(k, i)];
            finer.extend([[i, a, c], [j, b, a], [k, c, b], [a, b, c]]);
        }
        faces = finer;
        for point in &mut points {
            *point = point.normalize();
        }
    }
    (points.iter().map(|point| point.normalize().to_array()).collect(), faces)
}

/// A closed lens of 2 × 2, about 0.05 thick, with pillows on its inner side; `n` squares along each
/// side.
fn pillow_lens(n: u32) -> Mesh {
    let mut vertices = Vec::new();
    for back in [false, true] {
        for row in 0..=n {
            for column in 0..=n {
                let [x, y] = [column, row].map(|i| 2.0 * f64::from(i) / f64::from(n) - 1.0);
                let pillow = 0.01 * ((8.0 * PI * x).cos() * (8.0 * PI * y).cos()).powi(2);
                let front = -0.2 * (x * x + y * y);
                vertices.push([x, y, if back { front - 0.05 - pillow } else { front }]);
            }
        }
    }
    let far = (n + 1) * (n + 1);
    let mut triangles = Vec::new();
    let mut quad = |a, b, c, d| triangles.extend([[a, b, c], [a, c, d]]);
    for row in 0..n {
        for column in 0..n {
            let a = row * (n + 1) + column;
            let [b, c, d] = [a + 1, a + n + 2, a + n + 1];
            quad(a, b, c, d);
            quad(far + a, far + d, far + c, far + b);
        }
    }
    for i in 0..n {
        let mut side = |a, b| quad(a, far + a, far + b, b);
        side(i, i + 1);
        side(n * (n + 1) + i + 1, n * (n + 1) + i);
        side((i + 1) * (n + 1), i * (n + 1));
        side(i * (n + 1) + n, (i + 1) * (n + 1) + n);
    }
    (vertices, triangles)
}

/// What a lamp's meshes are like: in mm, in m given as mm, and a kilometre away from the origin.
const PLACES: [(f64, f64); 3] = [(50.0, 0.0), (50e3, 0.0), (50.0, 1e6)];

/// Points on every vertex and edge of a mesh: the places where a test with gaps loses rays.
fn seams((vertices, triangles): &Mesh) -> Vec<DVec3> {
    let mut random = Random(7);
    let point = |i: u32| DVec3::from_array(vertices[i as usize]);
    let mut seams: Vec<DVec3> = vertices.iter().map(|&vertex| DVec3::from_array(vertex)).collect();
    for &[i, j, _] in triangles {
        seams.push((point(i) + point(j)) / 2.0);
        seams.push(point(i).lerp(point(j), f64::midpoint(random.signed(), 1.0)));
    }
    seams
}

/// Rays from inside a mesh at all its seams: how many leave it unnoticed?
fn lost_rays(mesh: &Mesh, inside: &[DVec3]) -> usize {
    let triangles = build(mesh);
    let seams = seams(mesh);
    let rays = inside.iter().flat_map(|&from| seams.iter().map(move |&to| towards(from, to)));
    rays.filter(|ray| triangles.closest_hit(ray).is_none() || !triangles.any_hit(ray)).count()
}

#[test]
fn no_ray_leaves_a_sphere_through_an_edge_or_a_vertex() {
    for (scale, offset) in PLACES {
        let mesh = placed(icosphere(5), scale, offset);
        let mut random = Random(1);
        let inside = [0; 8].map(|_| DVec3::splat(offset) + random.vector() * 0.5 * scale);
        assert_eq!(lost_rays(&mesh, &inside), 0, "scale {scale}, offset {offset}");
    }
}

#[test]
fn no_ray_leaves_a_thin_lens_through_an_edge_or_a_vertex() {
    for (scale, offset) in PLACES {
        let mesh = placed(pillow_lens(64), scale, offset);
        let inside = [(0.0, 0.0), (0.31, -0.47), (-0.9, 0.83)].map(|(x, y)| {
            DVec3::new(x, y, -0.2 * (x * x + y * y) - 0.025) * scale + DVec3::splat(offset)
        });
        assert_eq!(lost_rays(&mesh, &inside), 0, "scale {scale}, offset {offset}");
    }
}

#[test]
fn a_ray_that_leaves_a_surface_does_not_meet_it_again() {
    for scale in [1e-3, 1.0, 50.0, 50e3] {
        for offset in [0.0, 1.0, 1e3, 1e6] {
            let sphere = build(&placed(icosphere(4), scale, offset));
            let mut random = Random(3);
            let centre = DVec3::splat(offset);
            for _ in 0..1 << 11 {
                let start = centre + random.direction() * 3.0 * scale;
                let hit = sphere
                    .closest_hit(&towards(start, centre + random.vector() * 0.5 * scale))
                    .unwrap();
                let mut direction = random.direction();
                direction *= direction.dot(hit.normal).signum();
                // Grazing directions are the hard ones.
                let grazing =
                    (direction - hit.normal * direction.dot(hit.normal) * (1.0 - 1e-6)).normalize();
                for outward in [direction, grazing] {
                    let outside = ray(hit.position + hit.normal * hit.error, outward);
                    assert_eq!(
                        sphere.closest_hit(&outside),
                        None,
                        "scale {scale}, offset {offset}"
                    );
                    let inside = ray(hit.position - hit.normal * hit.error, -outward);
                    let next = sphere.closest_hit(&inside).unwrap();
                    assert_ne!(next.triangle, hit.triangle, "scale {scale}, offset {offset}");
                }
            }
        }
    }
}

/// A triangle about 100 long and 10⁻³ wide, with one corner near the centre, where coordinates have
/// more digits.
fn sliver(random: &mut Random) -> [DVec3; 3] {
    let along = random.direction() * 50.0;
    [along, -along + random.vector() * 1e-3, random.vector() * 1e-3]
}

fn alone(corners: [DVec3; 3]) -> Triangles {
    build(&(corners.map(|corner| corner.to_array()).to_vec(), vec![[0, 1, 2]]))
}

#[test]
fn a_ray_that_leaves_a_sliver_does_not_meet_it_again() {
    let mut random = Random(23);
    for _ in 0..1 << 13 {
        let corners = sliver(&mut random);
        let triangle = alone(corners);
        let [u, v] = [random.signed(), random.signed()].map(|x| x.abs() / 2.0);
        let target = corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
        let Some(hit) = triangle.closest_hit(&towards(target + random.direction() * 30.0, target))
        else {
            continue;
        };
        let along = (corners[1] - corners[0]).reject_from_normalized(hit.normal).normalize();
        for side in [1.0, -1.0] {
            let away = side * hit.normal;
            let origin = hit.position + hit.error * away;
            for direction in [away, along + 1e-9 * away, random.direction() + 1.01 * away] {
                assert_eq!(triangle.closest_hit(&ray(origin, direction.normalize())), None);
            }
        }
    }
}

#[test]
fn an_edge_on_triangle_is_hit_on_itself() {
    let mut random = Random(29);
    let mut hits = 0;
    for _ in 0..1 << 14 {
        let corners = [0; 3].map(|_| random.vector().as_vec3().as_dvec3());
        let triangle = alone(corners);
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let direction =
            (corners[1] - corners[0]).lerp(corners[2] - corners[0], random.signed()).normalize();
        if let Some(hit) = triangle.closest_hit(&ray(middle - 5.0 * direction, direction)) {
            hits += 1;
            assert!((hit.t - 5.0).abs() < 3.5, "{}", hit.t);
        }
    }
    assert!(hits > 100, "{hits}");
}

#[test]
fn a_film_of_ten_micrometres_one_metre_from_the_origin_is_resolved() {
    // Two sheets at x = 1000 and 1000.01 mm, and a triangle at the origin that moves the centre
    // away from them.
    let sheet = |x: f64| [[x, -50.0, -50.0], [x, 50.0, -50.0], [x, 50.0, 50.0], [x, -50.0, 50.0]];
    let mut vertices = [sheet(1000.0), sheet(1000.01)].concat();
    vertices.extend([[0.0, 0.0, 200.0], [1.0, 0.0, 200.0], [0.0, 1.0, 200.0]]);
    let film = build(&(vertices, vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7], [8, 9, 10]]));
    let mut random = Random(5);
    for _ in 0..1 << 14 {
        let target = DVec3::new(1000.0, random.signed() * 49.0, random.signed() * 49.0);
        let first = film.closest_hit(&towards(DVec3::ZERO, target)).unwrap();
        let direction = (target + random.vector() * 300.0).normalize();
        let onward =
            ray(first.position + first.error * direction.signum().x * first.normal, direction);
        let second = film.closest_hit(&onward).unwrap();
        assert!(first.triangle < 2 && (2..4).contains(&second.triangle));
        // The sheets' positions are rounded to single precision: 500 mm from the centre, by up to
        // 15 nm each.
        let thickness = second.t * direction.x;
        assert!((thickness - 0.01).abs() < 31e-6, "{thickness}");
    }
}

#[test]
fn all_kernels_give_the_same_hits_bit_for_bit() {
    let mesh = placed(pillow_lens(40), 50.0, 3.0);
    let reference = build(&mesh).with_kernel(Kernel::Portable).unwrap();
    let seams = seams(&mesh);
    for kernel in Kernel::available() {
        let triangles = build(&mesh).with_kernel(kernel).unwrap();
        assert_eq!(triangles.kernel_name(), kernel.name());
        let mut random = Random(11);
        for &seam in &seams {
            let origin = DVec3::splat(3.0) + random.vector() * 100.0;
            for mut ray in [towards(origin, seam), ray(seam, random.direction())] {
                assert_eq!(triangles.closest_hit(&ray), reference.closest_hit(&ray));
                ray.t_max = 60.0;
                assert_eq!(triangles.any_hit(&ray), reference.any_hit(&ray));
                assert_eq!(triangles.any_hit(&ray), reference.closest_hit(&ray).is_some());
            }
        }
    }
}

/// Distance and triangle by the textbook: every triangle, Cramer's rule in double precision.
fn exhaustive((vertices, triangles): &Mesh, ray: &Ray) -> Option<(f64, u32)> {
    let point = |i: u32| DVec3::from_array(vertices[i as usize]);
    let mut nearest: Option<(f64, u32)> = None;
    for (index, corners) in triangles.iter().enumerate() {
        let [a, b, c] = corners.map(point);
        let (ab, ac, ao) = (b - a, c - a, ray.origin - a);
        let determinant = -ray.direction.dot(ab.cross(ac));
        let u = -ray.direction.dot(ao.cross(ac)) / determinant;
        let v = -ray.direction.dot(ab.cross(ao)) / determinant;
        let t = ao.dot(ab.cross(ac)) / determinant;
        let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0;
        if inside && nearest.is_none_or(|(nearest, _)| t < nearest) {
            nearest = Some((t, index as u32));
        }
    }
    nearest
}

#[test]
fn the_closest_hit_is_what_an_exhaustive_search_finds() {
    let mut random = Random(13);
    // Triangles of very different sizes; vertices on a grid that single precision holds exactly.
    let mut soup: Mesh = (Vec::new(), Vec::new());
    for i in 0..600 {
        let centre = random.vector() * 64.0;
        let size = 2.0_f64.powf(3.0 + 5.0 * random.signed());
        soup.1.push([3 * i, 3 * i + 1, 3 * i + 2]);
        let corners = [0; 3].map(|_| ((centre + random.vector() * size) * 256.0).round() / 256.0);
        soup.0.extend(corners.map(|corner| corner.to_array()));
    }
    let triangles = build(&soup);
    let mut hits = 0;
    for _ in 0..20_000 {
        let ray = ray(random.vector() * 100.0, random.direction());
        let found = triangles.closest_hit(&ray);
        let expected = exhaustive(&soup, &ray);
        assert_eq!(found.map(|hit| hit.triangle), expected.map(|(_, triangle)| triangle));
        assert_eq!(triangles.any_hit(&ray), expected.is_some());
        if let (Some(found), Some((t, _))) = (found, expected) {
            hits += 1;
            assert!((found.t - t).abs() < 1e-9);
            assert!(found.position.distance(ray.origin + t * ray.direction) < 1e-9);
        }
    }
    assert!(hits > 5_000);
}

#[test]
fn all_hits_begin_with_the_closest_and_are_odd_in_number_from_inside_with_every_kernel() {
    let mesh = icosphere(3);
    for kernel in Kernel::available() {
        let mut random = Random(11);
        let set = build(&mesh).with_kernel(kernel).unwrap();
        for size in [0.5, 4.0].repeat(1000) {
            let ray = ray(random.direction() * size, random.direction());
            let mut found = Vec::new();
            set.all_hits(&ray, &mut found);
            found.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.triangle.cmp(&b.triangle)));
            assert_eq!(found.first().copied(), set.closest_hit(&ray));
            assert_eq!(found.len() % 2 == 1, size < 1.0);
            if let [first, last] = found[..] {
                let ray = Ray { t_max: last.t, ..ray };
                found.clear();
                set.all_hits(&ray, &mut found);
                assert_eq!(found, [first]);
            }
        }
    }
}

#[test]
fn only_faces_of_two_bodies_in_one_plane_touch() {
    let square = |z: f64, size: f64| {
        [[-size, -size, z], [size, -size, z], [size, size, z], [-size, size, z]]
    };
    let touching = |heights: [f64; 2]| {
        let vertices = [square(heights[0], 50.0), square(heights[1], 7.3)].concat();
        let triangles = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]];
        let set = Triangles::build(&vertices, &triangles).unwrap();
        let mut found = set.touching(&[0, 0, 1, 1], set.rounding(), |_, _| true, |a, b| a != b);
        found.sort_unstable();
        found
    };
    assert_eq!(touching([1.0, 1.0]), [0, 1, 2, 3]);
    assert_eq!(touching([1.0, 1.0 + 1e-5]), [0, 1, 2, 3]);
    assert!(touching([1.0, 1.0 + 1e-4]).is_empty());
}

#[test]
fn a_camera_may_be_a_thousand_kilometres_away() {
    let mesh = icosphere(4);
    let sphere = build(&mesh);
    let mut random = Random(17);
    for _ in 0..2_000 {
        let target = random.vector() * 0.5;
        let direction = random.direction();
        let near = sphere.closest_hit(&ray(target - direction * 2.0, direction)).unwrap();
        let far = sphere.closest_hit(&ray(target - direction * 1e9, direction)).unwrap();
        // 10⁹ mm in double precision: steps of 10⁻⁷ mm.
        assert!(near.position.distance(far.position) < 2e-6);
        assert!((far.t - near.t - (1e9 - 2.0)).abs() < 2e-6);
    }
}

#[test]
fn rays_along_the_axes_meet_flat_meshes() {
    let flat = (
        vec![[0.0, 0.0, 5.0], [4.0, 0.0, 5.0], [4.0, 4.0, 5.0], [0.0, 4.0, 5.0]],
        vec![[0, 1, 2], [0, 2, 3]],
    );
    let square = build(&flat);
    for (x, y) in [(1.0, 2.0), (2.0, 2.0), (0.0, 0.0), (4.0, 3.0)] {
        let hit = square.closest_hit(&ray(DVec3::new(x, y, 0.0), DVec3::Z)).unwrap();
        assert_eq!(hit.t, 5.0);
        assert_eq!(hit.position, DVec3::new(x, y, 5.0));
        assert_eq!(hit.normal, DVec3::Z);
    }
    // In the plane, beside the square, away from it, and no rays at all.
    assert_eq!(square.closest_hit(&ray(DVec3::new(-1.0, 1.0, 5.0), DVec3::X)), None);
    assert_eq!(square.closest_hit(&ray(DVec3::new(5.0, 1.0, 0.0), DVec3::Z)), None);
    assert_eq!(square.closest_hit(&ray(DVec3::ONE, -DVec3::Z)), None);
    assert_eq!(square.closest_hit(&ray(DVec3::ONE, DVec3::NAN)), None);
    assert_eq!(square.closest_hit(&ray(DVec3::ONE, DVec3::ZERO)), None);
    assert_eq!(square.closest_hit(&ray(DVec3::splat(f64::NAN), DVec3::Z)), None);
}

#[test]
fn a_hit_counts_only_before_the_end_of_the_ray() {
    let triangle =
        build(&(vec![[0.0, 0.0, 5.0], [4.0, 0.0, 5.0], [0.0, 4.0, 5.0]], vec![[0, 1, 2]]));
    for (t_max, expected) in [(4.999, false), (5.0, false), (5.001, true)] {
        let ray = Ray { origin: DVec3::new(1.0, 1.0, 0.0), direction: DVec3::Z, t_max };
        assert_eq!(triangle.closest_hit(&ray).is_some(), expected);
        assert_eq!(triangle.any_hit(&ray), expected);
    }
}

#[test]
fn of_triangles_at_the_same_distance_the_first_is_hit() {
    let (vertices, faces) = icosphere(3);
    let twice = build(&(vertices, [faces.clone(), faces.clone()].concat()));
    let mut random = Random(31);
    for _ in 0..2_000 {
        let hit = twice.closest_hit(&ray(DVec3::ZERO, random.direction())).unwrap();
        assert!((hit.triangle as usize) < faces.len());
    }
}

#[test]
fn barycentric_weights_give_the_position_back() {
    let mesh = placed(icosphere(2), 20.0, 4.0);
    let sphere = build(&mesh);
    let mut random = Random(19);
    for _ in 0..1_000 {
        let hit = sphere.closest_hit(&ray(DVec3::splat(4.0), random.direction())).unwrap();
        let [a, b, c] =
            mesh.1[hit.triangle as usize].map(|i| DVec3::from_array(mesh.0[i as usize]));
        let [u, v] = hit.barycentric;
        assert!(
            (a + u * (b - a) + v * (c - a)).distance(hit.position) < 20.0 * f64::from(f32::EPSILON)
        );
    }
}

#[test]
fn triangles_that_cannot_be_used_are_refused() {
    let vertices = [[0.0; 3], [1.0; 3], [f64::NAN; 3], [1e13, 0.0, 0.0]];
    let fault = |triangle| Triangles::build(&vertices, &[[0, 0, 1], triangle]).err().unwrap();
    let (triangle, vertices) = (1, 4);
    assert_eq!(fault([0, 1, 4]), TrianglesError::NoSuchVertex { triangle, vertex: 4, vertices });
    assert_eq!(fault([0, 1, 2]), TrianglesError::NotFinite { triangle, vertex: 2 });
    assert_eq!(fault([0, 1, 3]), TrianglesError::TooLarge { extent: 1e13 });
    for kernel in [Kernel::Portable, Kernel::Avx2, Kernel::Avx512] {
        let one = build(&(vec![[0.0; 3], [1.0; 3]], vec![[0, 1, 1]]));
        let refused =
            one.with_kernel(kernel).err() == Some(TrianglesError::NoSuchKernel { kernel });
        assert_eq!(refused, !kernel.is_available());
    }
}

#[test]
fn no_triangles_are_never_hit() {
    let none = build(&(Vec::new(), Vec::new()));
    assert!(none.is_empty() && none.bounds().is_none() && none.memory_bytes() == 0);
    assert_eq!(none.closest_hit(&ray(DVec3::ZERO, DVec3::X)), None);
    assert!(!none.any_hit(&ray(DVec3::ZERO, DVec3::X)));
}
