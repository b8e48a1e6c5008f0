// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace orrery::support {

/// An uncompressed EXR file with the channels R, G and B, which may hold any bits and declare any colour space.
struct ExrFile {
  int width = 0, height = 0;
  std::vector<float> rgb;             ///< width * height * 3, rows from the top
  std::string color_interop_id = {};  ///< empty: none
  std::vector<float> chromaticities{};
  int display_width = 0;  ///< of the display window, from the same corner; 0: width
  bool is_half = false;   ///< the values, normal numbers or infinite, are in half precision instead of single

  static ExrFile constant(int width, int height, std::array<float, 3> color) {
    ExrFile out{width, height, {}};
    for (int i = 0; i < width * height; ++i) out.rgb.insert(out.rgb.end(), color.begin(), color.end());
    return out;
  }

  /// The bytes of the file.
  ///
  /// Reference  the OpenEXR file layout
  std::string bytes() const {
    std::string out("\x76\x2f\x31\x01\x02\0\0\0", 8);
    const auto add = [&out](const auto& value) { out.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
    const auto attribute = [&](const std::string& name, const std::string& type, const std::string& value) {
      out += name + '\0' + type + '\0';
      add(static_cast<std::int32_t>(value.size()));
      out += value;
    };
    const auto packed = [](const auto& values) {
      return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0]));
    };
    std::string channels;
    for (const char* name : {"B", "G", "R"}) {
      channels += name + std::string(1, '\0');
      channels += packed(std::array<std::int32_t, 4>{is_half ? 1 : 2, 0, 1, 1});  // type, not linear, every pixel
    }
    const auto window = [&](int right) { return packed(std::array<std::int32_t, 4>{0, 0, right - 1, height - 1}); };
    const std::string one = packed(std::array<float, 1>{1});
    attribute("channels", "chlist", channels + '\0');
    if (!chromaticities.empty()) attribute("chromaticities", "chromaticities", packed(chromaticities));
    if (!color_interop_id.empty()) attribute("colorInteropID", "string", color_interop_id);
    attribute("compression", "compression", std::string(1, '\0'));
    attribute("dataWindow", "box2i", window(width));
    attribute("displayWindow", "box2i", window(display_width > 0 ? display_width : width));
    attribute("lineOrder", "lineOrder", std::string(1, '\0'));
    attribute("pixelAspectRatio", "float", one);
    attribute("screenWindowCenter", "v2f", packed(std::array<float, 2>{0, 0}));
    attribute("screenWindowWidth", "float", one);
    out += '\0';
    const std::size_t values = 3 * (is_half ? 2 : 4) * static_cast<std::size_t>(width), line = 8 + values,
                      rows = static_cast<std::size_t>(height);
    const std::size_t first = out.size() + 8 * rows;
    for (std::size_t y = 0; y < rows; ++y) add(static_cast<std::uint64_t>(first + y * line));
    for (std::size_t y = 0; y < rows; ++y) {
      add(static_cast<std::int32_t>(y));
      add(static_cast<std::int32_t>(values));
      for (std::size_t c = 3; c-- > 0;)
        for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
          const float value = rgb[3 * (y * static_cast<std::size_t>(width) + x) + c];
          if (is_half) {
            add(half_bits(value));
          } else {
            add(value);
          }
        }
    }
    return out;
  }

 private:
  static std::uint16_t half_bits(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t exponent = bits >> 23 & 0xFF, mantissa = bits >> 13 & 0x3FF;
    return static_cast<std::uint16_t>((bits >> 16 & 0x8000) | (exponent == 0xFF ? 0x1F : exponent - 112) << 10 |
                                      mantissa);
  }
};

}  // namespace orrery::support
