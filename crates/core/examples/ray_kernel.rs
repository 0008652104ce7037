// SPDX-License-Identifier: Apache-2.0 OR MIT
//! Measures the triangle kernel on recorded rays.
//!
//! ```text
//! ray_kernel record MESH RAYS COUNT
//! ray_kernel trace MESH RAYS [SLICE]
//! ```
//!
//! `record` follows camera rays through the mesh as if it were glass, and writes COUNT of them.
//! `trace` builds, then traces on one thread: all rays, or SLICE of them at a time, the next for each
//! line of stdin. It prints one JSON line each time.
//!
//! MESH: u64 number of vertices, u64 number of triangles, vertices as 3 f64, triangles as 3 u32.
//! RAYS: u64 number of rays, rays as 7 f64: origin, direction, `t_max` (for any hit). All
//! little-endian.

use std::error::Error;
use std::fs::{read, File};
use std::hint::black_box;
use std::io::{stdin, BufWriter, Write};
use std::path::Path;
use std::time::Instant;

use glam::DVec3;
use lamplit_core::geometry::{Kernel, TriangleHit, Triangles};
use lamplit_core::math::Ray;

type Mesh = (Vec<[f64; 3]>, Vec<[u32; 3]>);
type Outcome<T> = Result<T, Box<dyn Error>>;

fn main() -> Outcome<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        ["record", mesh, rays, count] => record(mesh.as_ref(), rays.as_ref(), count.parse()?),
        ["trace", mesh, rays] => trace(mesh.as_ref(), rays.as_ref(), None),
        ["trace", mesh, rays, slice] => trace(mesh.as_ref(), rays.as_ref(), Some(slice.parse()?)),
        _ => {
            Err("usage: ray_kernel record MESH RAYS COUNT | ray_kernel trace MESH RAYS [SLICE]"
                .into())
        }
    }
}

fn trace(mesh: &Path, rays: &Path, slice: Option<usize>) -> Outcome<()> {
    let (vertices, faces) = read_mesh(mesh)?;
    let rays = read_rays(rays)?;
    let begin = Instant::now();
    let mut triangles = Triangles::build(&vertices, &faces)?;
    let build_s = begin.elapsed().as_secs_f64();
    let bytes = triangles.memory_bytes() as f64 / faces.len() as f64;
    for rays in rays.chunks(slice.unwrap_or(rays.len()).max(1)).cycle() {
        let mut kernels = Vec::new();
        for kernel in Kernel::available() {
            triangles = triangles.with_kernel(kernel)?;
            let closest = rate(rays, |ray| triangles.closest_hit(&unlimited(ray)).is_some());
            let any = rate(rays, |ray| triangles.any_hit(ray));
            kernels.push(format!(r#""{kernel}":{{"closest":{closest},"any":{any}}}"#));
        }
        println!(
            r#"{{"triangles":{},"rays":{},"build_s":{build_s:.4},"bytes_per_triangle":{bytes:.1},{}}}"#,
            faces.len(),
            rays.len(),
            format_args!(r#""kernels":{{{}}}"#, kernels.join(","))
        );
        if stdin().read_line(&mut String::new())? == 0 {
            break;
        }
    }
    Ok(())
}

fn unlimited(ray: &Ray) -> Ray {
    Ray { t_max: f64::INFINITY, ..*ray }
}

/// Rays per second, and the number of rays for which `test` holds, as JSON.
fn rate(rays: &[Ray], test: impl Fn(&Ray) -> bool) -> String {
    let begin = Instant::now();
    let hits = rays.iter().filter(|ray| black_box(test(ray))).count();
    let rate = rays.len() as f64 / begin.elapsed().as_secs_f64();
    format!(r#"{{"rays_per_s":{rate:.0},"hits":{hits}}}"#)
}

/// Camera rays from in front of the mesh (+z), each followed through up to 12 surfaces of glass:
/// reflected or refracted with the probability that Fresnel's equations give. For any hit, a ray
/// ends at a random share of its way through the box.
fn record(mesh: &Path, rays: &Path, count: usize) -> Outcome<()> {
    let (vertices, faces) = read_mesh(mesh)?;
    let triangles = Triangles::build(&vertices, &faces)?;
    let [lo, hi] = triangles.bounds().ok_or("the mesh is empty")?;
    let (centre, size) = ((lo + hi) / 2.0, hi - lo);
    let eye = centre + size.length() * DVec3::new(0.4, 0.2, 1.5);
    let mut random = Random(1);
    let mut file = BufWriter::new(File::create(rays)?);
    file.write_all(&(count as u64).to_le_bytes())?;
    // Row by row, as a picture is rendered: neighbours in the list are neighbours in space.
    let side = (count as f64 / 4.0).sqrt().ceil();
    let pixels = (0..).map(|pixel| {
        DVec3::new(f64::from(pixel) % side, (f64::from(pixel) / side).floor() % side, 0.0)
    });
    let mut recorded = 0;
    for pixel in pixels {
        let place = (pixel + DVec3::new(random.next(), random.next(), 0.0)) / side - 0.5;
        let mut ray = Ray {
            origin: eye,
            direction: (centre + place * size - eye).normalize(),
            t_max: f64::INFINITY,
        };
        for _ in 0..12 {
            if recorded == count {
                return Ok(file.flush()?);
            }
            recorded += 1;
            let reach = random.next() * size.length();
            let numbers =
                [ray.origin.to_array().as_slice(), &ray.direction.to_array(), &[reach]].concat();
            for number in numbers {
                file.write_all(&number.to_le_bytes())?;
            }
            let Some(hit) = triangles.closest_hit(&ray) else {
                break;
            };
            ray = follow(&ray, &hit, random.next(), size.length() * 1e-6);
        }
    }
    Ok(())
}

/// The ray reflected or refracted at a surface of glass (n = 1.49) whose normal points out of it.
/// It starts `gap` off the surface: far enough for a tracer that works in single precision alone,
/// so that all peers see the same hits.
fn follow(ray: &Ray, hit: &TriangleHit, choice: f64, gap: f64) -> Ray {
    let outside = ray.direction.dot(hit.normal) < 0.0;
    let (normal, eta) = if outside { (hit.normal, 1.0 / 1.49) } else { (-hit.normal, 1.49) };
    let cos_i = -ray.direction.dot(normal);
    let cos_t_squared = 1.0 - eta * eta * (1.0 - cos_i * cos_i);
    let cos_t = cos_t_squared.max(0.0).sqrt();
    let parallel = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let perpendicular = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let reflectance = f64::midpoint(parallel * parallel, perpendicular * perpendicular);
    let reflected = cos_t_squared <= 0.0 || choice < reflectance;
    let direction = if reflected {
        ray.direction + 2.0 * cos_i * normal
    } else {
        eta * ray.direction + (eta * cos_i - cos_t) * normal
    };
    Ray {
        origin: hit.position + if reflected { gap } else { -gap } * normal,
        direction: direction.normalize(),
        t_max: f64::INFINITY,
    }
}

/// Marsaglia's 64-bit xorshift; `next` is uniform in 0..1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn read_mesh(path: &Path) -> Outcome<Mesh> {
    let bytes = read(path)?;
    let mut words = bytes.chunks_exact(8);
    let [vertices, faces] =
        [word(&mut words)?, word(&mut words)?].map(|word| u64::from_le_bytes(word) as usize);
    let mut points = Vec::with_capacity(vertices);
    for _ in 0..vertices {
        points.push([number(&mut words)?, number(&mut words)?, number(&mut words)?]);
    }
    let corners = bytes
        .get(16 + 24 * vertices..)
        .ok_or("the mesh is cut short")?
        .chunks_exact(12)
        .take(faces);
    let corner =
        |bytes: &[u8], i: usize| u32::from_le_bytes(std::array::from_fn(|k| bytes[4 * i + k]));
    Ok((
        points,
        corners.map(|bytes| [corner(bytes, 0), corner(bytes, 1), corner(bytes, 2)]).collect(),
    ))
}

fn read_rays(path: &Path) -> Outcome<Vec<Ray>> {
    let bytes = read(path)?;
    let mut words = bytes.chunks_exact(8);
    let count = u64::from_le_bytes(word(&mut words)?);
    let mut rays = Vec::new();
    for _ in 0..count {
        let mut numbers = [0.0; 7];
        for value in &mut numbers {
            *value = number(&mut words)?;
        }
        rays.push(Ray {
            origin: DVec3::from_slice(&numbers[..3]),
            direction: DVec3::from_slice(&numbers[3..6]),
            t_max: numbers[6],
        });
    }
    Ok(rays)
}

fn word<'a>(words: &mut impl Iterator<Item = &'a [u8]>) -> Outcome<[u8; 8]> {
    Ok(words.next().ok_or("the file is cut short")?.try_into()?)
}

fn number<'a>(words: &mut impl Iterator<Item = &'a [u8]>) -> Outcome<f64> {
    Ok(f64::from_le_bytes(word(words)?))
}
