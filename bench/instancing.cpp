// SPDX-License-Identifier: Apache-2.0
// Compares instances of an asymmetric unit with expanded spheres, for docs/decisions/0025:
//
//   bench_instancing 1M4X.pdb instances   Embree instances of the unit's sphere points
//   bench_instancing 1M4X.pdb expanded    Embree's sphere points of all copies
//   bench_instancing 1M4X.pdb bvh         all copies in orrery's BVH of many spheres, single rays
//
// Prints the spheres, and seconds of one thread: of the build, and of a million closest hits in single precision. The
// rays start far outside and end at points near the surface of the largest sphere that fits.
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "accel/accel.h"
#include "accel/embree_compat.h"
#include "kernel/ray_packet.h"
#include "kernel/scene_view.h"

namespace {

using namespace orrery;

struct Sphere {
  float x, y, z, radius;
};

/// Three rows of four.
using Transform = std::vector<float>;

constexpr double kRadius = 1.7;  // carbon, angstrom

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// A PDB file's atoms and the transforms of its assemblies.
struct Assembly {
  std::vector<Sphere> unit;
  std::vector<Transform> transforms;

  explicit Assembly(const char* file) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with("ATOM  ") && line.size() >= 54)
        unit.push_back({std::strtof(line.substr(30, 8).c_str(), nullptr),
                        std::strtof(line.substr(38, 8).c_str(), nullptr),
                        std::strtof(line.substr(46, 8).c_str(), nullptr), static_cast<float>(kRadius)});
      const std::size_t at = line.find("BIOMT");
      float v[4];
      if (at == std::string::npos || std::sscanf(line.c_str() + at + 6, "%*s %f %f %f %f", v, v + 1, v + 2, v + 3) != 4)
        continue;
      if (line[at + 5] == '1') transforms.emplace_back();
      transforms.back().insert(transforms.back().end(), v, v + 4);
    }
  }

  template <class F>
  void each_sphere(F f) const {
    for (const Transform& t : transforms)
      for (const Sphere& s : unit) {
        const auto row = [&](std::size_t i) { return t[i] * s.x + t[i + 1] * s.y + t[i + 2] * s.z + t[i + 3]; };
        f(Sphere{row(0), row(4), row(8), s.radius});
      }
  }
};

RTCScene scene_of(RTCDevice device, const std::vector<Sphere>& spheres) {
  const RTCScene scene = rtcNewScene(device);
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* const to = static_cast<Sphere*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(Sphere), spheres.size()));
  std::copy(spheres.begin(), spheres.end(), to);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  return scene;
}

RTCScene instances_of(RTCDevice device, const Assembly& assembly) {
  const RTCScene unit = scene_of(device, assembly.unit), scene = rtcNewScene(device);
  for (const Transform& t : assembly.transforms) {
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, unit);
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, t.data());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene);
  return scene;
}

/// Traces the rays of a packet; results as those of kernel::trace.
using Trace = std::function<void(kernel::RayPacketFast&)>;

Trace with_embree(RTCScene scene) {
  return [scene](kernel::RayPacketFast& packet) {
    for (int i = 0; i < packet.count; ++i) {
      RTCRayHit ray{};
      ray.ray.org_x = packet.origin[0][i], ray.ray.org_y = packet.origin[1][i], ray.ray.org_z = packet.origin[2][i];
      ray.ray.dir_x = packet.direction[0][i], ray.ray.dir_y = packet.direction[1][i];
      ray.ray.dir_z = packet.direction[2][i];
      ray.ray.tfar = packet.distance[i];
      ray.ray.mask = ~0u;
      ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      accel::EmbreeContext context;
      accel::init(context);
      accel::intersect(scene, context, ray);
      if (ray.hit.geomID != RTC_INVALID_GEOMETRY_ID) packet.hit[i] = ray.hit.primID;
    }
  };
}

/// All copies in an accelerator of orrery's, with what it refers to.
struct Expanded {
  std::vector<float> centers;
  std::unique_ptr<accel::Accel> accel;

  explicit Expanded(const Assembly& assembly) {
    const std::size_t count = assembly.unit.size() * assembly.transforms.size();
    centers.reserve(3 * count + 1);
    assembly.each_sphere([&](const Sphere& s) { centers.insert(centers.end(), {s.x, s.y, s.z}); });
    centers.push_back(0);  // a vector of four is read from each centre
    kernel::SceneView view;
    view.sphere_count = count;
    view.spheres.plain_count = 0;
    view.spheres.centers = centers.data();
    view.spheres.radius_palette = &kRadius;
    accel = accel::make_embree(view, kernel::Precision::kFast, {}, 1);
    accel->use({accel::Traversal::kSingle, accel::Traversal::kSingle});
  }
};

/// Rays from a sphere of three times the assembly's extent to points at 0.95 of it.
class Rays {
 public:
  explicit Rays(const Assembly& assembly) {
    assembly.each_sphere([&](const Sphere& s) { extent_ = std::max(extent_, std::hypot(s.x, s.y, s.z)); });
  }

  void next(kernel::RayPacketFast& packet) {
    packet = {};
    packet.count = kernel::kPacketSize;
    for (int i = 0; i < packet.count; ++i) {
      float from[3], to[3];
      direction(from);
      direction(to);
      float square = 0;
      for (int k = 0; k < 3; ++k) {
        packet.origin[k][i] = packet.offset[k][i] = 3 * extent_ * from[k];
        packet.direction[k][i] = 0.95F * extent_ * to[k] - packet.origin[k][i];
        square += packet.direction[k][i] * packet.direction[k][i];
      }
      for (auto& component : packet.direction) component[i] /= std::sqrt(square);
      packet.inverse_square[i] = 1;
      packet.self[i] = kernel::kNoSphere;
    }
    kernel::reset_hits(packet);
  }

 private:
  void direction(float (&d)[3]) {
    for (float& x : d) x = normal_(engine_);
    const float length = std::hypot(d[0], d[1], d[2]);
    for (float& x : d) x /= length;
  }

  float extent_ = 0;
  std::mt19937 engine_{1};
  std::normal_distribution<float> normal_;
};

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc == 3 ? argv[2] : "";
  if (mode != "instances" && mode != "expanded" && mode != "bvh")
    return std::fputs("usage: bench_instancing FILE.pdb instances|expanded|bvh\n", stderr), 2;
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const Assembly assembly(argv[1]);
  const std::size_t count = assembly.unit.size() * assembly.transforms.size();
  if (count == 0) return std::fprintf(stderr, "%s: no atoms or no BIOMT records\n", argv[1]), 1;
  Rays rays(assembly);

  const double begin = cpu_seconds();
  std::unique_ptr<Expanded> all;
  Trace trace;
  if (mode == "bvh") {
    all = std::make_unique<Expanded>(assembly);
    trace = [tracer = all->accel->tracer()](kernel::RayPacketFast& packet) { kernel::trace(tracer, packet); };
  } else {
    const RTCDevice device = rtcNewDevice("threads=1");
    std::vector<Sphere> expanded;
    if (mode == "expanded") {
      expanded.reserve(count);
      assembly.each_sphere([&](const Sphere& s) { expanded.push_back(s); });
    }
    trace = with_embree(mode == "expanded" ? scene_of(device, expanded) : instances_of(device, assembly));
  }
  const double built = cpu_seconds();
  constexpr int kBatches = 125;
  std::vector<kernel::RayPacketFast> packets(500);
  int hits = 0;
  double traced = 0;
  for (int batch = 0; batch < kBatches; ++batch) {
    for (kernel::RayPacketFast& packet : packets) rays.next(packet);
    const double start = cpu_seconds();
    for (kernel::RayPacketFast& packet : packets) trace(packet);
    traced += cpu_seconds() - start;
    for (const kernel::RayPacketFast& packet : packets)
      for (const std::uint32_t hit : packet.hit) hits += hit != kernel::kNoSphere;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const int rays_traced = kBatches * static_cast<int>(packets.size()) * kernel::kPacketSize;
  std::printf("%s: %zu spheres in %zu copies; build %.2f s, %.2f M rays/s (%d of %d hit), peak %.0f MB\n", mode.c_str(),
              assembly.unit.size(), assembly.transforms.size(), built - begin, rays_traced / traced / 1e6, hits,
              rays_traced, static_cast<double>(usage.ru_maxrss) / 1024);
}
