// SPDX-License-Identifier: Apache-2.0
#include "display/develop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "base/error.h"
#include "display/settings.h"
#include "film/picture.h"
#include "support/temp_dir.h"

namespace orrery::display {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

using Rgb = std::array<float, 3>;

film::Picture flat(int width, int height, Rgb color) {
  film::Picture picture{width, height, {}};
  const auto pixels = static_cast<std::size_t>(width * height);
  const char* const names[3] = {"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c) picture.planes.push_back({names[c], std::vector<float>(pixels, color[c])});
  return picture;
}

std::vector<std::uint16_t> shown(Rgb color, const Settings& settings, int bits = 8) {
  return develop(flat(1, 1, color), settings, bits).values;
}

std::vector<std::uint16_t> grey(int level) { return std::vector<std::uint16_t>(3, static_cast<std::uint16_t>(level)); }

Settings on(const std::string& display, const std::string& view = "Un-tone-mapped") {
  Settings settings;
  settings.display = display;
  settings.view = view;
  return settings;
}

/// The tests use the built-in config, whatever $OCIO is.
class DisplayDevelop : public testing::Test {
 protected:
  void SetUp() override { ::unsetenv("OCIO"); }
};

TEST_F(DisplayDevelop, PixelsInGroupsAreThoseOfTheWholeImage) {
  Settings settings = on("sRGB");
  settings.exposure = 1.5;
  std::vector<float> rgb;
  film::Picture picture{50, 2, {}};
  for (const char* name : {"R", "G", "B"}) picture.planes.push_back({name, {}});
  for (int i = 0; i < 100; ++i)
    for (int c = 0; c < 3; ++c) {
      rgb.push_back(i == 7 ? kNan : i == 8 ? -kInfinity : static_cast<float>(0.004 * i * (c + 1) - 0.01));
      picture.planes[static_cast<std::size_t>(c)].values.push_back(rgb.back());
    }
  const std::vector<std::uint16_t> whole = develop(picture, settings, 8).values;
  std::vector<std::uint8_t> codes(300);
  const PixelDeveloper developer(settings);
  for (std::size_t i = 0; i < 100; i += 20) developer(&rgb[3 * i], nullptr, 20, &codes[3 * i]);
  EXPECT_TRUE(std::equal(whole.begin(), whole.end(), codes.begin()));
}

struct Level {
  const char* display;
  float linear;
  double encoded;  ///< by the display's standard, 0..1
};

class DisplayDevelopCurve : public testing::TestWithParam<Level> {
 protected:
  void SetUp() override { ::unsetenv("OCIO"); }
};

TEST_P(DisplayDevelopCurve, EncodesGreyAsTheDisplayStandardDefines) {
  const auto [display, linear, encoded] = GetParam();
  const auto values = shown({linear, linear, linear}, on(display), 16);
  // The float matrices have an error of 1e-6, times the slope of the curve.
  for (const std::uint16_t v : values) EXPECT_NEAR(v, encoded * 65535, 1.5) << display << " " << linear;
}

/// IEC 61966-2-1.
double srgb(double v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055; }

INSTANTIATE_TEST_SUITE_P(Displays, DisplayDevelopCurve,
                         testing::Values(Level{"sRGB", 0.5f, srgb(0.5)}, Level{"sRGB", 0.18f, srgb(0.18)},
                                         Level{"sRGB", 0.002f, srgb(0.002)}, Level{"sRGB", 1, 1},
                                         Level{"Display P3", 0.5f, srgb(0.5)}, Level{"Display P3", 0.002f, srgb(0.002)},
                                         Level{"Display P3", 1, 1},
                                         Level{"Rec.1886 Rec.709", 0.18f, std::pow(0.18, 1 / 2.4)},
                                         Level{"Rec.1886 Rec.709", 1, 1},
                                         Level{"P3-D65 Cinema", 0.18f, std::pow(0.18, 1 / 2.6)},
                                         Level{"P3-D65 Cinema", 1, 1}, Level{"Gamma 2.0 Rec.709", 0.25f, 0.5},
                                         Level{"Gamma 2.0 Rec.709", 0.04f, 0.2}, Level{"Gamma 2.0 Rec.709", 1, 1}));

TEST_F(DisplayDevelop, EncodesGreyToWellKnownLevels) {
  EXPECT_EQ(shown({0.5f, 0.5f, 0.5f}, on("sRGB")), grey(188));
  EXPECT_EQ(shown({0.18f, 0.18f, 0.18f}, on("sRGB")), grey(118));
  EXPECT_EQ(shown({0.36f, 0.36f, 0.36f}, on("Gamma 2.0 Rec.709")), grey(153));
}

TEST_F(DisplayDevelop, ConvertsRec709RedToP3) {
  // Rec.709 red in P3 is 0.82246, 0.03319, 0.01708.
  EXPECT_EQ(shown({1, 0, 0}, on("sRGB")), (std::vector<std::uint16_t>{255, 0, 0}));
  EXPECT_EQ(shown({1, 0, 0}, on("Display P3")), (std::vector<std::uint16_t>{234, 51, 35}));
  EXPECT_EQ(shown({1, 0, 0}, on("P3-D65 Cinema")), (std::vector<std::uint16_t>{237, 69, 53}));
}

TEST_F(DisplayDevelop, AcesMapsMiddleGreyToATenthOfWhite) {
  // The output transform maps 18 % grey to 4.8 of 48 cd/m2 in a dark cinema. For video in a dim surround, luminance is
  // raised to the power 0.9811.
  const auto values = shown({0.18f, 0.18f, 0.18f}, on("sRGB", "ACES 1.0 SDR Video"), 16);
  for (const std::uint16_t v : values) EXPECT_NEAR(v, srgb(std::pow(0.1, 0.9811)) * 65535, 65535 * 0.001);
  const auto bright = shown({8, 8, 8}, on("sRGB", "ACES 1.0 SDR Video"), 16);
  for (const std::uint16_t v : bright) EXPECT_TRUE(v > 62000 && v < 65535) << v;  // rolls off instead of clipping
}

TEST_F(DisplayDevelop, RawChangesNothing) {
  EXPECT_EQ(shown({0.2f, 0.4f, 0.6f}, on("sRGB", "Raw")), (std::vector<std::uint16_t>{51, 102, 153}));
}

TEST_F(DisplayDevelop, UsesTheConfigsDefaultDisplayAndView) {
  const Choice choice = choose({});
  EXPECT_EQ(choice.config, "built-in");
  EXPECT_EQ(choice.display, "sRGB");
  EXPECT_EQ(choice.view, "Un-tone-mapped");
  EXPECT_TRUE(choice.warnings.empty());
}

TEST_F(DisplayDevelop, ExposureIsInStops) {
  Settings brighter = on("sRGB");
  brighter.exposure = 2;
  EXPECT_EQ(shown({0.1f, 0.02f, 0.2f}, brighter, 16), shown({0.4f, 0.08f, 0.8f}, on("sRGB"), 16));
  brighter.exposure = 1000;  // overflows, but black stays black
  EXPECT_EQ(shown({0.1f, 0, 0.1f}, brighter), (std::vector<std::uint16_t>{255, 0, 255}));
  brighter.exposure = -1000;
  EXPECT_EQ(shown({1000, 1000, 1000}, brighter), grey(0));
  brighter.exposure = -20;  // values beyond half are not clamped before the exposure
  EXPECT_EQ(shown({0x1p19f, 0x1p19f, 0x1p19f}, brighter), grey(188));
}

TEST_F(DisplayDevelop, ALookActsOnSaturatedColoursOnly) {
  Settings settings = on("sRGB", "Raw");
  settings.working_space = "acescg";
  const Rgb saturated = {0.05f, 0.8f, -0.1f}, neutral = {0.3f, 0.3f, 0.3f};
  const auto plain = shown(saturated, settings), plain_grey = shown(neutral, settings);
  settings.look = "ACES 1.3 gamut compress";
  EXPECT_EQ(plain[2], 0);
  EXPECT_GT(shown(saturated, settings)[2], 0);  // compressed into the gamut
  EXPECT_EQ(shown(neutral, settings), plain_grey);
}

TEST_F(DisplayDevelop, NeutralKeepsDarkColoursAndTheHueOfBrightOnes) {
  for (const char* display : {"sRGB", "Display P3", "Gamma 2.0 Rec.709"}) {
    const Settings neutral = on(display, "Neutral"), plain = on(display);
    EXPECT_EQ(shown({0.02F, 0.4F, 0.79F}, neutral, 16), shown({0.02F, 0.4F, 0.79F}, plain, 16)) << display;
    const float peak = 0.8F + 0.05F * std::log(1 + 1.2F / 0.05F);  // of 2
    const std::vector<std::uint16_t> bright = shown({2, 1, 0.5F}, neutral, 16),
                                     expected = shown({peak, peak / 2, peak / 4}, plain, 16);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(bright[c], expected[c], 8) << display;
  }
}

/// A white page stays white, and a pixel that objects half cover is half of each.
TEST_F(DisplayDevelop, LooksOfTheViewDoNotApplyToTheBackdrop) {
  Settings settings = on("sRGB", "Neutral");
  settings.backdrop = math::Vec3d{1, 1, 1};
  film::Picture picture{3, 1, {}};
  const float peak = 0.8F + 0.05F * std::log(1 + 1.2F / 0.05F);
  for (const char* name : {"R", "G", "B"}) picture.planes.push_back({name, {1, 1.5F, 2}});
  picture.coverage = {0, 0.5F, 1};
  const std::vector<std::uint16_t> values = develop(picture, settings, 16).values;
  EXPECT_EQ(values[0], 65535);
  EXPECT_NEAR(values[3], srgb((1 + peak) / 2) * 65535, 4);
  EXPECT_NEAR(values[6], srgb(peak) * 65535, 4);
  float rgb[] = {1, 1, 1};
  std::uint8_t codes[3];
  const PixelDeveloper developer(settings);
  developer(rgb, picture.coverage.data(), 1, codes);
  EXPECT_EQ(codes[0], 255);
  picture.coverage.clear();
  EXPECT_LT(develop(picture, settings, 16).values[0], 64000) << "unknown coverage";
}

TEST_F(DisplayDevelop, ResolvesTheWorkingSpaceByNameRoleAndAlias) {
  for (const char* space : {"lin_rec709", "scene_linear", "linear"}) {
    Settings settings = on("sRGB");
    settings.working_space = space;
    EXPECT_EQ(shown({0.5f, 0.5f, 0.5f}, settings), grey(188)) << space;
  }
  Settings wide = on("sRGB");
  wide.working_space = "acescg";
  const auto red = shown({0.5f, 0, 0}, wide);
  EXPECT_GT(red[0], 200);  // more saturated than Rec.709 red
  EXPECT_EQ(red[1], 0);
}

TEST_F(DisplayDevelop, ClampsTheResultAndMapsNonFiniteValuesToBlack) {
  const Settings settings = on("sRGB");
  EXPECT_EQ(shown({-1, -1, -1}, settings), grey(0));
  EXPECT_EQ(shown({2, 2, 2}, settings), grey(255));
  EXPECT_EQ(shown({3e38f, 3e38f, 3e38f}, settings), grey(255));
  EXPECT_EQ(shown({kNan, kNan, kNan}, settings), grey(0));
  EXPECT_EQ(shown({kInfinity, kInfinity, kInfinity}, settings), grey(0));
  // An invalid channel does not affect the others.
  EXPECT_EQ(shown({kNan, 0.5f, kInfinity}, settings), shown({0, 0.5f, 0}, settings));
  EXPECT_EQ(shown({kNan, 0.5f, -kInfinity}, on("sRGB", "ACES 1.0 SDR Video")),
            shown({0, 0.5f, 0}, on("sRGB", "ACES 1.0 SDR Video")));
}

TEST_F(DisplayDevelop, FindsPlanesByNameAndIgnoresAlpha) {
  film::Picture picture = flat(2, 1, {0.2f, 0.4f, 0.6f});
  const auto expected = develop(picture, {}, 8).values;
  picture.planes.push_back({"A", {0, 0.5f}});
  std::swap(picture.planes[0], picture.planes[3]);
  std::swap(picture.planes[1], picture.planes[2]);
  EXPECT_EQ(develop(picture, {}, 8).values, expected);
}

TEST_F(DisplayDevelop, KeepsPixelPositions) {
  // More pixels than are transformed at a time, and not a multiple of that number.
  film::Picture picture{301, 107, {}};
  const std::size_t pixels = 301 * 107;
  std::vector<float> ramp(pixels);
  for (std::size_t i = 0; i < pixels; ++i) ramp[i] = static_cast<float>(i * 2) / 65535.0f;
  picture.planes = {{"R", ramp}, {"G", std::vector<float>(pixels)}, {"B", ramp}};
  const film::EncodedPicture out = develop(picture, on("sRGB", "Raw"), 16);
  EXPECT_EQ(out.width, 301);
  EXPECT_EQ(out.height, 107);
  ASSERT_EQ(out.values.size(), pixels * 3);
  for (std::size_t i = 0; i < pixels; ++i) {
    ASSERT_EQ(out.values[i * 3], i * 2);
    ASSERT_EQ(out.values[i * 3 + 1], 0);
    ASSERT_EQ(out.values[i * 3 + 2], i * 2);
  }
}

TEST_F(DisplayDevelop, StraightAlphaUnpremultipliesColours) {
  film::Picture picture{4, 1, {}};
  const std::vector<float> alpha = {0, 0.25f, 1, -0.5f};
  const std::vector<float> light = {0, 0.1f, 0.4f, 0.3f};
  picture.planes = {{"R", light}, {"G", light}, {"B", light}, {"A", alpha}};
  const film::EncodedPicture out = develop(picture, on("sRGB", "Raw"), 8, Alpha::kStraight);
  EXPECT_EQ(out.channels, 4);
  EXPECT_EQ(out.values, (std::vector<std::uint16_t>{0, 0, 0, 0, 102, 102, 102, 64, 102, 102, 102, 255, 0, 0, 0, 0}));
  EXPECT_EQ(develop(picture, on("sRGB", "Raw"), 8).channels, 3) << "over black";
  picture.planes.pop_back();
  EXPECT_THROW(develop(picture, on("sRGB"), 8, Alpha::kStraight), base::Error);
}

TEST_F(DisplayDevelop, RoundsToTheNearestLevel) {
  for (int level = 0; level < 255; ++level) {
    const float below = (static_cast<float>(level) + 0.49f) / 255, above = (static_cast<float>(level) + 0.51f) / 255;
    ASSERT_EQ(shown({below, below, below}, on("sRGB", "Raw")), grey(level));
    ASSERT_EQ(shown({above, above, above}, on("sRGB", "Raw")), grey(level + 1));
  }
}

TEST_F(DisplayDevelop, ClampsToBlackAndWhite) {
  for (const float v : {0.0f, 1.0f, 7.0f, -1.0f}) EXPECT_EQ(shown({v, v, v}, on("sRGB", "Raw")), grey(v > 0 ? 255 : 0));
}

TEST_F(DisplayDevelop, ReportsWhetherTheResultIsSrgb) {
  const film::Picture picture = flat(1, 1, {1, 1, 1});
  EXPECT_TRUE(develop(picture, on("sRGB"), 8).is_srgb);
  EXPECT_TRUE(develop(picture, on("sRGB", "ACES 1.0 SDR Video"), 8).is_srgb);
  EXPECT_FALSE(develop(picture, on("sRGB", "Raw"), 8).is_srgb);
  EXPECT_FALSE(develop(picture, on("Gamma 2.0 Rec.709"), 8).is_srgb);
  EXPECT_FALSE(develop(picture, on("Display P3"), 8).is_srgb);

  const support::TempDir folder;
  support::write_bytes(folder / "linear.ocio",
                       "ocio_profile_version: 2\nenvironment: {}\nroles: {default: Linear Rec.709 (sRGB)}\n"
                       "displays:\n  monitor:\n    - !<View> {name: Plain, colorspace: Linear Rec.709 (sRGB)}\n"
                       "colorspaces:\n  - !<ColorSpace> {name: Linear Rec.709 (sRGB)}\n");
  Settings settings;
  settings.config = (folder / "linear.ocio").string();
  settings.working_space = "Linear Rec.709 (sRGB)";
  EXPECT_FALSE(develop(picture, settings, 8).is_srgb) << "linear, in spite of its name";
}

TEST_F(DisplayDevelop, RefusesAnImageWithoutColour) {
  const film::Picture picture{1, 1, {{"R", {1}}, {"B", {1}}}};
  try {
    develop(picture, {}, 8);
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
    EXPECT_STREQ(error.what(), "the image has no channel G");
  }
}

}  // namespace
}  // namespace orrery::display
