// SPDX-License-Identifier: Apache-2.0
// Every stage before rendering can be stopped: none works on for seconds on a scene of many spheres.
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <random>

#include "accel/accel.h"
#include "base/error.h"
#include "base/stop_point.h"
#include "compile/compile.h"
#include "compile/compiled_scene.h"
#include "data/data_file.h"
#include "data/write_table.h"
#include "job/run_job.h"
#include "job/scene_hash.h"
#include "scene/diagnostic.h"
#include "scene/number_array.h"
#include "scene/scene.h"
#include "scene/validate.h"
#include "support/temp_dir.h"

namespace orrery::job {
namespace {

data::Table table_of(std::size_t rows) {
  std::mt19937 random(1);
  data::Table out;
  out.rows = rows;
  for (const char* name : {"x", "y", "z"}) {
    std::vector<float> values(rows);
    for (float& v : values) v = static_cast<float>(random()) * 0x1p-32F;
    out.columns.push_back({name, std::move(values)});
  }
  return out;
}

scene::Scene scene_of(const data::Table& table) {
  scene::Scene scene;
  scene.materials = {{"grey", scene::Lambertian{}}};
  scene::Points points;
  points.centers = scene::PointArray(table.rows);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < table.rows; ++i)
      points.centers.set(i, axis, std::get<std::vector<float>>(table.columns[axis].values)[i]);
  points.radii = scene::NumberArray(table.rows, 1e-3);
  scene.points.push_back(std::move(points));
  return scene;
}

/// Whether a stage ends with kStopped where it is to stop, and works otherwise.
void expect_stoppable(const char* stage, const std::function<void()>& run) {
  EXPECT_NO_THROW(run()) << stage;
  const std::atomic<bool> flag{true};
  const base::StopScope scope(&flag);
  try {
    run();
    ADD_FAILURE() << stage << " does not stop";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kStopped) << stage;
  }
}

TEST(JobStop, EveryStageBeforeRenderingCanBeStopped) {
  const support::TempDir folder;
  const data::Table table = table_of(20'000);
  for (const char* name : {"a.ply", "a.csv", "a.npy"}) {
    static_cast<void>(data::write_table(folder / name, table));
    expect_stoppable(name, [&] { data::open(folder / name, {})->read(0, {"x", "y", "z"}); });
  }
  const scene::Scene scene = scene_of(table);
  expect_stoppable("validate", [&] { scene::validate(scene); });
  expect_stoppable("warn_of_coincident", [&] { scene::warn_of_coincident(scene, nullptr); });
  expect_stoppable("compile", [&] { compile::compile(scene); });
  const compile::CompiledScene compiled = compile::compile(scene);
  expect_stoppable("scene_hash", [&] { scene_hash(compiled); });
  expect_stoppable("make_embree", [&] { accel::make_embree(compiled.view(), kernel::Precision::kExact); });
}

TEST(JobStop, AJobStopsWhileItReads) {
  const support::TempDir folder;
  static_cast<void>(data::write_table(folder / "a.ply", table_of(1000)));
  support::write_bytes(folder / "a.toml",
                       "[material.grey]\ntype = \"lambertian\"\nalbedo = [0.5, 0.5, 0.5]\n"
                       "[[points]]\nfile = \"a.ply\"\nradius = 0.001\nmaterial = \"grey\"\n");
  const std::atomic<bool> flag{true};
  Job job;
  job.scene.file = folder / "a.toml";
  job.outputs.images = {folder / "a.png"};
  job.hooks.cancel = &flag;
  try {
    run_job(job);
    ADD_FAILURE() << "the job was not stopped";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kStopped);
    EXPECT_STREQ(error.what(), "stopped; nothing was written");
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
}

}  // namespace
}  // namespace orrery::job
