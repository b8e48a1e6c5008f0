// SPDX-License-Identifier: Apache-2.0
#include "job/statistics.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <regex>

#include "job/job.h"
#include "job/report_text.h"
#include "job/version.h"

namespace orrery::job {
namespace {

TEST(JobStatistics, RatesAreOverTheRenderTime) {
  JobReport report;
  report.render.paths = 600;
  report.render.rays = 1500;
  report.render.render_s = 3;
  report.phases.write_s = 100;
  const auto json = nlohmann::json::parse(statistics_json(report));
  EXPECT_EQ(json["paths_per_second"], 200);
  EXPECT_EQ(json["rays_per_second"], 500);
  EXPECT_EQ(json["seconds"]["write"], 100);
}

TEST(JobStatistics, RatesAreZeroWithoutRenderTime) {
  const auto json = nlohmann::json::parse(statistics_json({}));
  EXPECT_EQ(json["paths_per_second"], 0);
  EXPECT_EQ(json["rays_per_second"], 0);
}

TEST(JobStatistics, HasEveryKeyOfTheSchema) {
  const base::Error full(base::ErrorKind::kIo, "disk full");
  const auto json = nlohmann::json::parse(statistics_json({}, &full));
  EXPECT_EQ(json["schema"], "orrery.stats/1");
  EXPECT_EQ(json["exit_reason"], "failed");
  EXPECT_EQ(json["exit_status"], 74);
  EXPECT_EQ(json["error"], "disk full");
  for (const char* key : {"scene_hash", "width", "height", "samples", "spheres", "paths", "rays", "peak_memory_bytes",
                          "bad_samples", "bad_pixels", "written", "threads", "isa", "accelerator"})
    EXPECT_EQ(json.count(key), 1u) << key;
  for (const char* phase : {"read", "compile", "build", "render", "write"})
    EXPECT_EQ(json["seconds"].count(phase), 1u) << phase;
  EXPECT_EQ(json["versions"]["orrery"], program_version());
  for (const auto& [name, version] : library_versions()) EXPECT_EQ(json["versions"][name], version);
}

TEST(JobStatistics, PeakMemoryIsInBytes) {
  // The test program has more than 1 MiB, and no test machine has 1 PiB.
  const std::size_t peak = nlohmann::json::parse(statistics_json({}))["peak_memory_bytes"];
  EXPECT_GT(peak, std::size_t{1} << 20);
  EXPECT_LT(peak, std::size_t{1} << 50);
}

TEST(JobStatistics, JsonAcceptsFileNamesThatAreNotUtf8) {
  const std::string text = json_text({{"file", "a\xff.toml"}});
  EXPECT_EQ(text, "{\n  \"file\": \"a\xEF\xBF\xBD.toml\"\n}\n");
}

TEST(JobStatistics, EveryLibraryHasOne) {
  const std::regex version(R"(\d+(\.\d+)+.*)");
  EXPECT_TRUE(std::regex_match(program_version(), version)) << program_version();
  EXPECT_EQ(library_versions().size(), 8u);
  for (const auto& [name, text] : library_versions())
    EXPECT_TRUE(std::regex_match(text, version)) << name << ' ' << text;
}

}  // namespace
}  // namespace orrery::job
