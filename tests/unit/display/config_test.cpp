// SPDX-License-Identifier: Apache-2.0
#include "display/config.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "display/settings.h"
#include "display/view.h"
#include "support/temp_dir.h"

namespace orrery::display {
namespace {

namespace ocio = OCIO_NAMESPACE;

class DisplayConfig : public testing::Test {
 protected:
  void SetUp() override { ::unsetenv("OCIO"); }

  /// A .cube as `ociobakelut` writes it with the options of docs/output.md.
  static std::string baked(const std::string& display, const std::string& look) {
    const ocio::BakerRcPtr baker = ocio::Baker::Create();
    baker->setConfig(ocio::Config::CreateFromFile(ORRERY_ROOT "/src/display/config/luts.ocio"));
    baker->setFormat("resolve_cube");
    baker->setInputSpace("lin_rec709");
    baker->setShaperSpace("shaper");
    baker->setTargetSpace(display.c_str());
    baker->setLooks(look.c_str());
    baker->setShaperSize(65536);
    baker->setCubeSize(65);
    std::ostringstream out;
    baker->bake(out);
    return out.str();
  }

  /// The maximum difference between a view and the LUT applied by OCIO, over colours from black to beyond white.
  double largest_error(const Settings& settings, const std::string& lut) const {
    const std::string file = (folder_ / (settings.display + settings.view + ".cube")).string();
    support::write_bytes(file, lut);
    const ocio::FileTransformRcPtr transform = ocio::FileTransform::Create();
    transform->setSrc(file.c_str());
    transform->setInterpolation(ocio::INTERP_TETRAHEDRAL);
    const ocio::ConstCPUProcessorRcPtr table =
        ocio::Config::CreateRaw()->getProcessor(transform)->getOptimizedCPUProcessor(ocio::OPTIMIZATION_LOSSLESS);
    const View view = find_view(settings);
    const auto code = [](float v) { return static_cast<double>(std::clamp(v, 0.0F, 1.0F)); };
    double worst = 0;
    for (int r = 0; r < 12; ++r)
      for (int g = 0; g < 12; ++g)
        for (int b = 0; b < 12; ++b) {
          float exact[3], rounded[3];
          const int steps[3] = {r, g, b};
          for (int k = 0; k < 3; ++k) exact[k] = rounded[k] = 0.003F * static_cast<float>(std::pow(1.9, steps[k]) - 1);
          view.processor->applyRGB(exact);
          table->applyRGB(rounded);
          for (int k = 0; k < 3; ++k) worst = std::max(worst, std::abs(code(exact[k]) - code(rounded[k])));
        }
    return worst;
  }

  support::TempDir folder_;
};

TEST_F(DisplayConfig, LutsMatchTheViews) {
  for (const char* display : {"sRGB", "Gamma 2.0 Rec.709"}) {
    Settings settings;
    settings.display = display;
    settings.view = "Un-tone-mapped";
    EXPECT_LT(largest_error(settings, baked(display, "")), 0.001) << display;
  }
  Settings settings;
  settings.view = "ACES 1.0 SDR Video";
  EXPECT_LT(largest_error(settings, baked("sRGB", "ACES 1.0 SDR Video")), 0.01);
}

}  // namespace
}  // namespace orrery::display
