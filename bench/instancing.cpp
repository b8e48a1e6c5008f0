// SPDX-License-Identifier: Apache-2.0
// Compares Embree instances of an asymmetric unit with the expanded spheres, for docs/decisions/0026. Not part of the
// build:
//
//   g++ -O2 -std=c++20 -march=native bench/instancing.cpp -lembree3 -o instancing
//   ./instancing 1M4X.pdb instances
//   ./instancing 1M4X.pdb expanded
//
// Prints the spheres, and seconds of one thread: of the build, and of a million rays from a sphere around the capsid
// into it, one by one.
#include <embree3/rtcore.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <random>
#include <string>
#include <vector>

namespace {

struct Sphere {
  float x, y, z, radius;
};

/// Three rows of four.
using Transform = std::vector<float>;

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

Sphere transformed(const Transform& t, const Sphere& s) {
  const auto row = [&](std::size_t i) { return t[i] * s.x + t[i + 1] * s.y + t[i + 2] * s.z + t[i + 3]; };
  return {row(0), row(4), row(8), s.radius};
}

RTCScene scene_of(RTCDevice device, const std::vector<Sphere>& spheres) {
  const RTCScene scene = rtcNewScene(device);
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* const to = static_cast<Sphere*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(Sphere), spheres.size()));
  for (std::size_t i = 0; i < spheres.size(); ++i) to[i] = spheres[i];
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  return scene;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("usage: instancing FILE.pdb instances|expanded\n", stderr), 2;
  const bool instances = std::string(argv[2]) == "instances";
  std::vector<Sphere> unit;
  std::vector<Transform> transforms;
  std::ifstream in(argv[1]);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("ATOM  ") && line.size() >= 54)
      unit.push_back({std::strtof(line.substr(30, 8).c_str(), nullptr),
                      std::strtof(line.substr(38, 8).c_str(), nullptr),
                      std::strtof(line.substr(46, 8).c_str(), nullptr), 1.7F});
    const std::size_t at = line.find("BIOMT");
    float v[4];
    if (at == std::string::npos || std::sscanf(line.c_str() + at + 6, "%*s %f %f %f %f", v, v + 1, v + 2, v + 3) != 4)
      continue;
    if (line[at + 5] == '1') transforms.emplace_back();
    transforms.back().insert(transforms.back().end(), v, v + 4);
  }
  const double begin = cpu_seconds();
  const RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = nullptr;
  if (instances) {
    const RTCScene part = scene_of(device, unit);
    rtcCommitScene(part);
    scene = rtcNewScene(device);
    for (const Transform& t : transforms) {
      const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(geometry, part);
      rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, t.data());
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene, geometry);
      rtcReleaseGeometry(geometry);
    }
  } else {
    std::vector<Sphere> all;
    all.reserve(unit.size() * transforms.size());
    for (const Transform& t : transforms)
      for (const Sphere& s : unit) all.push_back(transformed(t, s));
    scene = scene_of(device, all);
  }
  rtcCommitScene(scene);
  const double built = cpu_seconds();
  constexpr float kFar = 3000;  // the capsid's radius is about 950
  constexpr int kRays = 1'000'000;
  std::mt19937 engine(1);
  std::normal_distribution<float> normal;
  int hits = 0;
  for (int i = 0; i < kRays; ++i) {
    const auto direction = [&] {
      const float x = normal(engine), y = normal(engine), z = normal(engine), r = std::sqrt(x * x + y * y + z * z);
      return Sphere{x / r, y / r, z / r, 0};
    };
    const Sphere from = direction(), to = direction();
    RTCRayHit ray{};
    ray.ray = {kFar * from.x, kFar * from.y, kFar * from.z, 0, 0, 0, 0, 0, INFINITY, 0xffffffffU, 0, 0};
    constexpr float kInside = 900;
    ray.ray.dir_x = kInside * to.x - ray.ray.org_x;
    ray.ray.dir_y = kInside * to.y - ray.ray.org_y;
    ray.ray.dir_z = kInside * to.z - ray.ray.org_z;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &ray);
    hits += ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }
  const double traced = cpu_seconds();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("%s: %zu spheres in %zu copies; build %.2f s, %.2f M rays/s (%d of %d hit), peak %.0f MB\n", argv[2],
              unit.size(), transforms.size(), built - begin, kRays / (traced - built) / 1e6, hits, kRays,
              static_cast<double>(usage.ru_maxrss) / 1024);
}
