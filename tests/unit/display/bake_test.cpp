// SPDX-License-Identifier: Apache-2.0
#include "display/bake.h"

#include <OpenColorIO/OpenColorIO.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "display/settings.h"
#include "display/view.h"
#include "support/temp_dir.h"

namespace orrery::display {
namespace {

namespace ocio = OCIO_NAMESPACE;

class DisplayBake : public testing::Test {
 protected:
  void SetUp() override { ::unsetenv("OCIO"); }

  /// The maximum difference between a view and the baked file applied by OCIO, over colours from black to beyond white.
  double largest_error(const Settings& settings, const std::string& name, const std::string& text) const {
    support::write_bytes(folder_ / name, text);
    ocio::ClearAllCaches();  // OCIO caches files by name
    auto transform = ocio::FileTransform::Create();
    transform->setSrc((folder_ / name).c_str());
    transform->setInterpolation(ocio::INTERP_TETRAHEDRAL);
    const auto file =
        ocio::Config::CreateRaw()->getProcessor(transform)->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
    const View view = find_view(settings);
    const float gain = static_cast<float>(std::exp2(settings.stops()));
    double worst = 0;
    for (int r = 0; r < 12; ++r)
      for (int g = 0; g < 12; ++g)
        for (int b = 0; b < 12; ++b) {
          float rgb[3], baked[3];
          const int steps[3] = {r, g, b};
          for (int k = 0; k < 3; ++k) {
            baked[k] = 0.003F * static_cast<float>(std::pow(1.9, steps[k]) - 1);
            rgb[k] = baked[k] * gain;
          }
          view.processor->applyRGB(rgb);
          file->applyRGB(baked);
          for (int k = 0; k < 3; ++k)
            worst = std::max(worst, static_cast<double>(
                                        std::abs(std::clamp(rgb[k], 0.0F, 1.0F) - std::clamp(baked[k], 0.0F, 1.0F))));
        }
    return worst;
  }

  support::TempDir folder_;
};

TEST_F(DisplayBake, ACubeMatchesTheView) {
  Settings settings;
  EXPECT_LT(largest_error(settings, "a.cube", bake_cube(settings, 33)), 0.02);
  EXPECT_LT(largest_error(settings, "a.cube", bake_cube(settings, 65)), 0.004);
  settings.exposure = -1;
  EXPECT_LT(largest_error(settings, "b.cube", bake_cube(settings, 65)), 0.004);
  settings.view = "ACES 1.0 SDR Video";
  EXPECT_LT(largest_error(settings, "c.cube", bake_cube(settings, 65)), 0.02);
}

TEST_F(DisplayBake, AClfOfSupportedTransformsIsExact) {
  Settings settings;
  settings.exposure = 1;
  for (const char* display : {"sRGB", "Gamma 2.0 Rec.709", "Display P3"}) {
    settings.display = display;
    const std::string text = bake_clf(settings, 65);
    EXPECT_EQ(text.find("<LUT3D"), std::string::npos) << display;
    EXPECT_LT(largest_error(settings, "a.clf", text), 1e-5) << display;
  }
}

TEST_F(DisplayBake, AClfOfAnAcesViewHoldsLuts) {
  Settings settings;
  settings.view = "ACES 1.0 SDR Video";
  const std::string text = bake_clf(settings, 33);
  EXPECT_NE(text.find("<LUT3D"), std::string::npos);
  EXPECT_LT(largest_error(settings, "a.clf", text), 0.05);
}

}  // namespace
}  // namespace orrery::display
