// SPDX-License-Identifier: Apache-2.0 OR MIT
// Embree 4 as a peer of the triangle kernel: the same meshes, the same rays, the same loop, one thread.
// The library comes without headers (PyPI wheel `embreex`), so the few declarations needed are repeated here
// from Embree 4's rtcore.h (Apache-2.0). Compiled and called by kernel.py.

#include <dlfcn.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <time.h>

typedef void *Handle;

enum { TRIANGLE = 0, INDEX_BUFFER = 0, VERTEX_BUFFER = 1, UINT3 = 0x5003, FLOAT3 = 0x9003, ROBUST = 1 << 2 };

struct Ray {
    float origin[3], t_near, direction[3], time, t_far;
    uint32_t mask, id, flags;
};

struct RayHit {
    struct Ray ray;
    float normal[3], u, v;
    uint32_t triangle, geometry, instance, instance_primitive;
    uint32_t reserve[4];
} __attribute__((aligned(16)));

static void (*intersect)(Handle, struct RayHit *, void *);
static void (*occluded)(Handle, struct Ray *, void *);

static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// Loads the library, builds the scene and returns it, or NULL. `build_s` receives the time of the commit.
Handle peer_build(const char *library, const char *device_options, const float *vertices, size_t vertex_count,
                  const uint32_t *triangles, size_t triangle_count, int robust, double *build_s) {
    Handle embree = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    if (!embree) return NULL;
    Handle (*new_device)(const char *) = dlsym(embree, "rtcNewDevice");
    Handle (*new_scene)(Handle) = dlsym(embree, "rtcNewScene");
    void (*set_flags)(Handle, int) = dlsym(embree, "rtcSetSceneFlags");
    Handle (*new_geometry)(Handle, int) = dlsym(embree, "rtcNewGeometry");
    void *(*new_buffer)(Handle, int, unsigned, int, size_t, size_t) = dlsym(embree, "rtcSetNewGeometryBuffer");
    void (*commit_geometry)(Handle) = dlsym(embree, "rtcCommitGeometry");
    unsigned (*attach)(Handle, Handle) = dlsym(embree, "rtcAttachGeometry");
    void (*commit_scene)(Handle) = dlsym(embree, "rtcCommitScene");
    intersect = dlsym(embree, "rtcIntersect1");
    occluded = dlsym(embree, "rtcOccluded1");
    if (!new_device || !new_scene || !set_flags || !new_geometry || !new_buffer || !commit_geometry || !attach ||
        !commit_scene || !intersect || !occluded)
        return NULL;

    Handle device = new_device(device_options);
    Handle scene = new_scene(device);
    set_flags(scene, robust ? ROBUST : 0);
    Handle geometry = new_geometry(device, TRIANGLE);
    memcpy(new_buffer(geometry, VERTEX_BUFFER, 0, FLOAT3, 12, vertex_count), vertices, 12 * vertex_count);
    memcpy(new_buffer(geometry, INDEX_BUFFER, 0, UINT3, 12, triangle_count), triangles, 12 * triangle_count);
    double begin = seconds();
    commit_geometry(geometry);
    attach(scene, geometry);
    commit_scene(scene);
    *build_s = seconds() - begin;
    return scene;
}

static struct Ray prepare(const double *ray, float t_far) {
    struct Ray prepared = {
        .origin = {(float)ray[0], (float)ray[1], (float)ray[2]},
        .direction = {(float)ray[3], (float)ray[4], (float)ray[5]},
        .t_far = t_far,
        .mask = UINT32_MAX,
    };
    return prepared;
}

// Rays are 7 doubles: origin, direction, end (for any hit). Returns the seconds taken; `hits` receives the number of hits.
double peer_closest(Handle scene, const double *rays, size_t count, size_t *hits) {
    double begin = seconds();
    *hits = 0;
    for (size_t i = 0; i < count; i++) {
        struct RayHit hit = {.ray = prepare(rays + 7 * i, __builtin_inff()),
                             .geometry = UINT32_MAX,
                             .instance = UINT32_MAX,
                             .instance_primitive = UINT32_MAX};
        intersect(scene, &hit, NULL);
        *hits += hit.geometry != UINT32_MAX;
    }
    return seconds() - begin;
}

double peer_any(Handle scene, const double *rays, size_t count, size_t *hits) {
    double begin = seconds();
    *hits = 0;
    for (size_t i = 0; i < count; i++) {
        struct Ray ray __attribute__((aligned(16))) = prepare(rays + 7 * i, (float)rays[7 * i + 6]);
        occluded(scene, &ray, NULL);
        *hits += ray.t_far < 0.0f;
    }
    return seconds() - begin;
}
