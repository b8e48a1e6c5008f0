// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "image/read.h"
#include "kernel/isa.h"

namespace orrery {
namespace {

namespace fs = std::filesystem;

struct StoredImage {
  const char* scene;
  std::uint64_t hash;  ///< FNV-1a of the bytes of all values
};

/// Writes the map of image textures: independent bytes, so that every level differs from the next.
void write_map(const fs::path& file) {
  constexpr int kWidth = 260, kHeight = 130;
  std::ofstream out(file, std::ios::binary);
  out << "P6\n" << kWidth << ' ' << kHeight << "\n255\n";
  std::uint32_t state = 1;
  for (int i = 0; i < 3 * kWidth * kHeight; ++i) {
    state = state * 1664525u + 1013904223u;
    out.put(static_cast<char>(state >> 24));
  }
}

/// Writes the centres of many spheres: enough for a BVH of many spheres, with AVX-512, where the program is not told
/// otherwise.
void write_centers(const fs::path& file) {
  std::ofstream out(file);
  out << "x,y,z\n";
  std::uint32_t state = 1;
  const auto uniform = [&state] { return ((state = state * 1664525u + 1013904223u) >> 12) * 1e-5; };
  for (int i = 0; i < 3000; ++i) out << uniform() << ',' << uniform() << ',' << uniform() << '\n';
}

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

class DeterminismProgram : public testing::TestWithParam<StoredImage> {
 protected:
  void SetUp() override {
    std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    std::replace(name.begin(), name.end(), '/', '-');
    folder_ = fs::path(testing::TempDir()) / ("orrery-determinism-" + name);
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    fs::copy_file(std::string(ORRERY_SCENES) + GetParam().scene, folder_ / GetParam().scene);
    write_map(folder_ / "map.ppm");
    write_centers(folder_ / "centers.csv");
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Renders the scene to a reproducible 32-bit EXR file; `arguments` are appended.
  fs::path render(const std::string& name, const std::string& arguments) {
    fs::path file = folder_ / (name + ".exr");
    run("\"" + (folder_ / GetParam().scene).string() + "\"", file, arguments, "");
    return file;
  }

  /// Renders the scene in several precisions as render() does, with `keys` in its table [render]; `variables` are set.
  /// One process renders all of them, since it takes longer to start than to render.
  ///
  /// Result     the files, in the order of the precisions
  std::vector<fs::path> render_each(const std::vector<std::string>& precisions, const std::string& name,
                                    const std::string& keys, const std::string& arguments = "",
                                    const std::string& variables = "") {
    const std::string text = bytes_of(folder_ / GetParam().scene), table = "[render]\n";
    const std::size_t end = text.find(table) + table.size();
    std::string scenes;
    std::vector<fs::path> files;
    for (const std::string& precision : precisions) {
      const fs::path version = folder_ / (name + "-" + precision);
      std::ofstream(version.string() + ".toml") << text.substr(0, end) << "precision = \"" << precision << "\"\n"
                                                << keys << text.substr(end);
      scenes += " \"" + version.string() + ".toml\"";
      files.push_back(version.string() + ".exr");
    }
    run(scenes, folder_ / "{scene}.exr", arguments, variables);
    return files;
  }

  fs::path folder_;

 private:
  static void run(const std::string& scenes, const fs::path& file, const std::string& arguments,
                  const std::string& variables) {
    const std::string command = variables + " \"" + ORRERY_PROGRAM + "\" render " + scenes + " -o \"" + file.string() +
                                "\" --type float --reproducible -q " + arguments;
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
  }
};

const std::vector<std::string> kPrecisions{"exact", "fast", "book"};

/// Compares pixel values; headers may differ.
bool same_values(const fs::path& a, const fs::path& b) {
  const film::Picture p = image::read(a), q = image::read(b);
  EXPECT_EQ(p.planes.size(), 4u);
  if (p.width != q.width || p.height != q.height || p.planes.size() != q.planes.size()) return false;
  for (std::size_t i = 0; i < p.planes.size(); ++i) {
    if (p.planes[i].name != q.planes[i].name || p.planes[i].values.size() != q.planes[i].values.size()) return false;
    if (std::memcmp(p.planes[i].values.data(), q.planes[i].values.data(), p.planes[i].values.size() * sizeof(float)) !=
        0)
      return false;
  }
  return true;
}

TEST_P(DeterminismProgram, TwoRunsGiveTheSameFile) { EXPECT_EQ(bytes_of(render("a", "")), bytes_of(render("b", ""))); }

TEST_P(DeterminismProgram, OneTwoAndFiveThreadsGiveTheSameFile) {
  const std::string one = bytes_of(render("one", "--threads 1"));
  EXPECT_TRUE(bytes_of(render("two", "--threads 2")) == one);
  EXPECT_TRUE(bytes_of(render("five", "--threads 5")) == one);
}

TEST_P(DeterminismProgram, EmbreeAndListGiveTheSameValuesInEveryPrecision) {
  const auto embree = render_each(kPrecisions, "embree", "accelerator = \"embree\"\n");
  const auto list = render_each(kPrecisions, "list", "accelerator = \"list\"\n", "--threads 3");
  for (std::size_t i = 0; i < kPrecisions.size(); ++i) EXPECT_TRUE(same_values(embree[i], list[i])) << kPrecisions[i];
}

/// SSE4 has no fused multiply-add, so its values may differ.
TEST_P(DeterminismProgram, EveryInstructionSetFromAvx2UpwardsGivesTheSameValues) {
  const auto best = render_each(kPrecisions, "best", "");
  for (const std::string& isa : kernel::available_isas()) {
    const auto limited = render_each(kPrecisions, isa, "", "--stats \"" + (folder_ / "{scene}.json").string() + "\"",
                                     "ORRERY_ISA=" + isa);
    for (std::size_t i = 0; i < kPrecisions.size(); ++i) {
      const std::string statistics = bytes_of(fs::path(limited[i]).replace_extension(".json"));
      EXPECT_NE(statistics.find("\"isa\": \"" + isa + "\""), std::string::npos) << "ORRERY_ISA was ignored";
      if (isa != "sse4") {
        EXPECT_TRUE(same_values(best[i], limited[i])) << isa << ", " << kPrecisions[i];
      }
    }
  }
}

/// Embree then divides packets: its callbacks would receive 8 rays of 16, or 4 of 8 or 16.
TEST_P(DeterminismProgram, AnEmbreeForFewerInstructionSetsGivesTheSameValues) {
  const std::vector<std::string> precisions{"exact", "fast"};  // book has no packets
  const auto plain = render_each(precisions, "plain", "");
  for (const std::string& isa : kernel::available_isas()) {
    if (isa == "sse4") continue;  // no Embree has fewer lanes
    for (const std::string limit : {"avx2", "sse4.2"}) {
      if (limit == isa) continue;
      const auto narrow = render_each(precisions, "narrow", "traversal = \"packet\"\n", "",
                                      "ORRERY_ISA=" + isa +
                                          " LD_PRELOAD=\"" NARROW_EMBREE
                                          "\" ASAN_OPTIONS=verify_asan_link_order=0 "
                                          "ORRERY_TEST_EMBREE=max_isa=" +
                                          limit);
      for (std::size_t i = 0; i < precisions.size(); ++i)
        EXPECT_TRUE(same_values(plain[i], narrow[i])) << isa << ", Embree with " << limit << ", " << precisions[i];
    }
  }
}

/// The hash holds for every compiler, optimization level, library and processor. Update it when sampling changes.
TEST_P(DeterminismProgram, ImageMatchesTheStoredHash) {
  if (kernel::isa_name() == "sse4") GTEST_SKIP() << "no fused multiply-add on this processor";
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const film::Plane& plane : image::read(render("picture", "")).planes) {
    for (const float value : plane.values) {
      std::uint32_t bits;
      std::memcpy(&bits, &value, sizeof(bits));
      for (int shift = 0; shift < 32; shift += 8) hash = (hash ^ (bits >> shift & 0xff)) * 0x100000001b3u;
    }
  }
  EXPECT_EQ(hash, GetParam().hash) << std::hex << hash;
}

TEST_P(DeterminismProgram, OptionsThatMatterChangeTheImage) {
  // Guards the tests above: they would pass if the program ignored its options.
  const auto plain = render("plain", "");
  EXPECT_FALSE(same_values(plain, render("seed", "--set render.seed=18")));
  EXPECT_FALSE(same_values(plain, render("depth", "--set render.max_depth=2")));
  const auto fast = render("fast", "--precision fast");
  EXPECT_FALSE(same_values(plain, fast));
  const auto versions = render_each({"exact", "fast"}, "version", "");
  EXPECT_TRUE(same_values(plain, versions[0]));
  EXPECT_TRUE(same_values(fast, versions[1]));
}

INSTANTIATE_TEST_SUITE_P(, DeterminismProgram,
                         testing::Values(StoredImage{"everything.toml", 0x3fa6a00f7e524967u},
                                         StoredImage{"lights.toml", 0x5e1133e0e9b006bfu},
                                         StoredImage{"sky-and-lights.toml", 0x448b4360c0706064u},
                                         StoredImage{"textures.toml", 0xf986224e4a21d9f2u},
                                         StoredImage{"image-textures.toml", 0xfcae157c25f25d31u},
                                         StoredImage{"rods.toml", 0xb85bc788337c7bdfu},
                                         StoredImage{"plastic.toml", 0xc50fcc0278083abau},
                                         StoredImage{"many.toml", 0xf0ce502a90666d53u},
                                         StoredImage{"opacity.toml", 0x781e3beaa08de889u}),
                         [](const auto& instance) {
                           std::string name = instance.param.scene;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name.substr(0, name.find('.'));
                         });

}  // namespace
}  // namespace orrery
