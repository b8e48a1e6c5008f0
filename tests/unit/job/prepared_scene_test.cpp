// SPDX-License-Identifier: Apache-2.0
#include "job/prepared_scene.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "base/error.h"
#include "film/picture.h"
#include "job/run_job.h"
#include "load/load_scene.h"
#include "support/temp_dir.h"

namespace orrery::job {
namespace {

const char* const kPreparedScene = R"(
image = { width = 24, height = 16 }
render = { samples = 2 }
background = { type = "constant", color = [0.3, 0.4, 0.5] }
camera = { look_from = [0, 1, 6], look_at = [0, 0, 0], vfov = 40 }
animation = { turntable = 8 }

[material]
ground = { type = "lambertian", albedo = [0.5, 0.5, 0.5] }
ball = { type = "metal", albedo = [0.8, 0.6, 0.2], fuzz = 0.2 }
checked = { type = "lambertian", albedo = { texture = "checker", scale = 0.3, even = [0.1, 0.1, 0.1], odd = [0.9, 0.9, 0.9] } }
lamp = { type = "emitter", radiance = [4, 4, 4] }

[[sphere]]
center = [0, -101, 0]
radius = 100
material = "ground"

[[sphere]]
center = [0, 2.5, 0]
radius = 0.5
material = "lamp"
name = "lamp"

[[sphere]]
center = [1, 0, 1]
radius = -0.4
material = "checked"

[[rod]]
from = [-1, 0, 1]
to = [1, 0.5, 1]
radius = 0.1
material = ["ground", "checked"]

[[rods]]
file = "bonds.csv"
radius = 0.05
material = ["ball", "ground"]

[[points]]
file = "cloud.csv"
material = "ball"
radius = 0.3
color = { column = "v" }
cryptomatte = ["v"]

[[points]]
file = "molecule.xyz"
material = "ground"
radius = 0.2
)";

/// Settings of which each step of a random sequence has some.
const std::vector<const char*> kSettings = {
    "camera.vfov=30",
    "camera.look_from=[1, 2, 7]",
    "camera.defocus_angle=1",
    "camera={shutter_open=0, shutter_close=0.5}",
    "image.width=20",
    "image.crop=[2, 2, 10, 8]",
    "render.samples=3",
    "render.seed=7",
    "render.max_depth=3",
    "render.precision=fast",
    "render.accelerator=list",
    "render.direct_lighting=bsdf",
    "render.filter=gaussian",
    "render.shading=normal",
    "material.ball.albedo=[0.1, 0.9, 0.1]",
    "material.ball.fuzz=0",
    "material.ball={type=\"dielectric\"}",
    "material.ball={type=\"lambertian\", albedo=[0.8, 0.8, 0.2], opacity=0.3}",
    "material.ball.opacity=0.6",
    "material.ground.opacity=0.5",
    "material.lamp.opacity=0.5",
    "material.ground={type=\"hemisphere\", albedo=[0.2, 0.2, 0.9]}",
    "material.checked.albedo={texture=\"noise\", scale=3}",
    "material.lamp.radiance=[9, 1, 1]",
    "material.lamp.light_group=\"key\"",
    "background.color=[1, 0, 0]",
    "background={type=\"sky\", sun_elevation=20}",
    "background.alpha=0",
    "sphere[0].radius=50",
    "sphere[1].material=\"ball\"",
    "sphere[1].name=\"other\"",
    "sphere[2].radius=0.4",
    "rod[0].radius=0.3",
    "rod[0].to=[-1, 2, 0]",
    "rod[0].material=\"lamp\"",
    "rod[0].name=\"bond\"",
    "rod=[]",
    "rods[0].radius=0.2",
    "rods[0].material=\"checked\"",
    "rods[0].group=\"bonds\"",
    "points[0].color.map=\"magma\"",
    "points[0].color.range=[0, 9]",
    "points[0].bonds={length=2}",
    "points[0].bonds={length=2, radius=0.01}",
    "points[0].bonds={length=2, material=\"lamp\"}",
    "points[0].opacity=0.4",
    "points[0].opacity={where=[\"v > 1: 0.2\"]}",
    "points[0].select=\"v > 1\"",
    "points[0].radius=0.1",
    "points[0].transform.scale=2",
    "points[0].material=\"lamp\"",
    "points[1].frame=2",
    "points[1].color={element=\"jmol\"}",
    "color.working=\"acescg\"",
    "color.exposure=1",
    "points[0].cryptomatte=[]",
    "points[1].cryptomatte=[\"element\"]",
    "output.layers=[\"Z\", \"CryptoObject\", \"CryptoMaterial\", \"material_id\"]"};

class JobPreparedScene : public testing::Test {
 protected:
  JobPreparedScene() {
    write_data(0);
    job_.scene.file = folder_ / "scene.toml";
    job_.scene.text = std::make_shared<const std::string>(kPreparedScene);
    job_.resources.threads = 1;
  }

  /// Writes data files; other versions have other contents.
  void write_data(int version) {
    std::string rows = "x,y,z,v\n";
    for (int i = 0; i < 9 + version; ++i)
      rows +=
          std::to_string(i % 3 - 1) + "," + std::to_string(i / 3 % 3 - 1) + ",0," + std::to_string(i + version) + "\n";
    support::write_bytes(folder_ / "cloud.csv", rows);
    support::write_bytes(folder_ / "bonds.csv",
                         "x0,y0,z0,x1,y1,z1\n-1,-1,2,1,1,2\n0,0,2,0,1," + std::to_string(2 + version) + "\n");
    support::write_bytes(folder_ / "molecule.xyz", "2\nfirst\nO 0 0 2\nH 0.5 0 2\n2\nsecond\nO 0 1 2\nH 0.5 1 " +
                                                       std::to_string(2 + version) + "\n");
  }

  void set(const std::vector<std::string>& settings) {
    job_.scene.overrides = {};
    for (const std::string& setting : settings) job_.scene.overrides.add(setting);
  }

  /// Renders with `prepared`, or from the beginning. The result is the error's text if it fails.
  std::string render(std::shared_ptr<PreparedScene> prepared, Rendering& out) const {
    Job job = job_;
    job.prepared = std::move(prepared);
    try {
      out = render_in_memory(job);
      return {};
    } catch (const base::Error& error) {
      std::string text = error.what();
      for (const base::Diagnostic& diagnostic : error.diagnostics()) text += "\n" + base::formatted(diagnostic);
      return text;
    }
  }

  static void expect_same(const film::Picture& a, const film::Picture& b) {
    ASSERT_EQ(a.planes.size(), b.planes.size());
    for (std::size_t i = 0; i < a.planes.size(); ++i) {
      EXPECT_EQ(a.planes[i].name, b.planes[i].name);
      ASSERT_EQ(a.planes[i].values.size(), b.planes[i].values.size());
      EXPECT_EQ(std::memcmp(a.planes[i].values.data(), b.planes[i].values.data(), a.planes[i].values.size() * 4), 0)
          << a.planes[i].name;
    }
  }

  support::TempDir folder_;
  Job job_;
};

TEST_F(JobPreparedScene, AnySequenceOfChangesGivesTheBitsOfAFreshStart) {
  std::mt19937 random(1);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  const auto prepared = std::make_shared<PreparedScene>(true);
  int failed = 0;
  for (int step = 0; step < 150; ++step) {
    std::vector<std::string> settings;
    for (std::size_t n = below(4); n > 0; --n) settings.push_back(kSettings[below(kSettings.size())]);
    set(settings);
    if (below(4) == 0) job_.scene.frame = 1 + static_cast<int>(below(3));  // the third frame does not exist
    if (below(8) == 0) write_data(static_cast<int>(below(3)));
    Rendering kept, fresh;
    const std::string kept_error = render(prepared, kept), fresh_error = render(nullptr, fresh);
    std::string text = "step " + std::to_string(step) + ", frame " + std::to_string(job_.scene.frame);
    for (const std::string& setting : settings) text += "\n" + setting;
    SCOPED_TRACE(text);
    ASSERT_EQ(kept_error, fresh_error);
    if (!fresh_error.empty()) {
      ++failed;
      continue;
    }
    EXPECT_EQ(kept.report.scene_hash, fresh.report.scene_hash);
    expect_same(kept.picture, fresh.picture);
    if (HasFailure()) break;
  }
  EXPECT_LT(failed, 75) << "most steps render";
}

TEST_F(JobPreparedScene, TheAcceleratorOutlivesWhatDoesNotMoveSpheres) {
  PreparedScene prepared;
  const auto accelerator = [&](const std::vector<std::string>& settings) -> const accel::Accel* {
    set(settings);
    load::SceneRequest request;
    request.source = job_.scene;
    prepared.load(request);
    prepared.compile(0);
    return &prepared.accelerator(1, {});
  };
  const accel::Accel* const first = accelerator({});
  for (const char* setting : {"camera.vfov=20", "image.width=30", "render.samples=9", "material.ball.albedo=[1, 0, 0]",
                              "material.ball.opacity=0.5", "points[0].opacity=0.3", "points[0].color.map=\"magma\"",
                              "points[0].color.range=[0, 2]", "background.color=[1, 1, 1]",
                              "sphere[1].material=\"ball\"", "rod[0].material=[\"ground\", \"lamp\"]",
                              "rods[0].material=\"lamp\"", "output.layers=[\"Z\"]", "color.exposure=2"}) {
    EXPECT_TRUE(prepared.has_accelerator());
    EXPECT_EQ(accelerator({setting}), first) << setting;
  }
  EXPECT_FALSE((set({"rod[0].radius=0.2"}), prepared.load({job_.scene, {}}), prepared.has_accelerator()));
  accelerator({});
  accelerator({"sphere[0].radius=99"});
  EXPECT_FALSE((set({}), prepared.load({job_.scene, {}}), prepared.has_accelerator()));
}

TEST_F(JobPreparedScene, ArrowsAreKnownAfterAChangeOfTheCamera) {
  PreparedScene prepared;
  const auto arrows = [&](const char* setting) {
    set({R"(points[0].vectors.columns=["x", "y", "z"])", setting});
    prepared.load({job_.scene, {}});
    prepared.compile(0);
    return prepared.loaded().read.scene.points[0].arrow_count;
  };
  EXPECT_EQ(arrows("camera.vfov=40"), 8u) << "one of nine vectors is null";
  EXPECT_EQ(arrows("camera.vfov=20"), 8u);
}

TEST_F(JobPreparedScene, ALargerImageMustFitIntoMemory) {
  const auto prepared = std::make_shared<PreparedScene>();
  Rendering rendering;
  EXPECT_EQ(render(prepared, rendering), "");
  job_.resources.memory_limit = 10'000'000;
  EXPECT_EQ(render(prepared, rendering), "");
  set({"image.width=2000", "image.height=2000"});
  EXPECT_NE(render(prepared, rendering).find("the render needs about"), std::string::npos);
}

TEST_F(JobPreparedScene, AFailureForgetsEverything) {
  const auto prepared = std::make_shared<PreparedScene>();
  Rendering first, second;
  EXPECT_EQ(render(prepared, first), "");
  set({"points[0].file=\"none.csv\""});
  EXPECT_NE(render(prepared, second), "");
  EXPECT_FALSE(prepared->has_accelerator());
  set({});
  EXPECT_EQ(render(prepared, second), "");
  expect_same(first.picture, second.picture);
}

}  // namespace
}  // namespace orrery::job
