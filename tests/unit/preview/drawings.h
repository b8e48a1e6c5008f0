// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "preview/png.h"

namespace orrery::preview {

// Small decoders of what terminals draw, written from the descriptions of the formats.

inline std::string decoded_base64(const std::string& text) {
  std::string out;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out += static_cast<char>(bits >> count & 0xff);
  }
  return out;
}

/// An image in kitty's protocol, and the keys of its first sequence.
inline Bitmap decoded_kitty(const std::string& drawing, std::map<std::string, std::string>* keys) {
  std::string payload, rest = drawing;
  bool more = true;
  while (!rest.empty()) {
    const std::size_t semicolon = rest.find(';'), end = rest.find("\033\\");
    if (!rest.starts_with("\033_G") || semicolon > end || !more) throw std::runtime_error("no kitty sequence");
    const std::string parameters = rest.substr(3, semicolon - 3),
                      data = rest.substr(semicolon + 1, end - semicolon - 1);
    if (data.size() > 4096) throw std::runtime_error("payload too long");
    const std::regex pair("([a-zA-Z])=([^,]*)");
    for (std::sregex_iterator i(parameters.begin(), parameters.end(), pair); i != std::sregex_iterator(); ++i)
      (*keys)[(*i)[1]] = (*i)[2];
    more = keys->at("m") == "1";
    payload += data;
    rest.erase(0, end + 2);
  }
  if (more) throw std::runtime_error("more data expected");
  const std::string bytes = decoded_base64(payload);
  return {std::stoi(keys->at("s")), std::stoi(keys->at("v")), {bytes.begin(), bytes.end()}};
}

/// An image in sixels; every pixel must be drawn exactly once.
inline Bitmap decoded_sixel(const std::string& drawing) {
  std::smatch head;
  const std::regex header("^\033P0;1q\"1;1;([0-9]+);([0-9]+)");
  if (!std::regex_search(drawing, head, header) || !drawing.ends_with("\033\\"))
    throw std::runtime_error("no sixel sequence");
  Bitmap out{std::stoi(head[1]), std::stoi(head[2]), {}};
  out.codes.resize(out.row_bytes() * static_cast<std::size_t>(out.height));
  std::vector<int> drawn(out.codes.size() / 3);
  std::map<int, std::array<int, 3>> palette;
  std::array<int, 3> color{};
  int x = 0, y = 0, repeat = 1;
  const std::string body = drawing.substr(static_cast<std::size_t>(head.length()),
                                          drawing.size() - static_cast<std::size_t>(head.length()) - 2);
  for (std::size_t i = 0; i < body.size();) {
    const char c = body[i++];
    std::vector<int> numbers;
    if (c == '#' || c == '!') {
      std::size_t used = 0;
      do {
        numbers.push_back(std::stoi(body.substr(i, 12), &used));
        i += used;
      } while (c == '#' && body[i] == ';' && ++i);
    }
    if (c == '#' && numbers.size() == 5) {
      if (numbers[1] != 2) throw std::runtime_error("colour space");
      palette[numbers[0]] = {numbers[2], numbers[3], numbers[4]};
    } else if (c == '#') {
      color = palette.at(numbers[0]);
    } else if (c == '!') {
      repeat = numbers[0];
    } else if (c == '$' || c == '-') {
      x = 0;
      if (c == '-') y += 6;
    } else {
      for (; repeat > 0; --repeat, ++x)
        for (int row = 0; row < 6; ++row) {
          if (((c - '?') >> row & 1) == 0) continue;
          if (x >= out.width || y + row >= out.height) throw std::runtime_error("sixel outside the image");
          const auto at = static_cast<std::size_t>((y + row) * out.width + x);
          ++drawn[at];
          for (std::size_t k = 0; k < 3; ++k)
            out.codes[3 * at + k] = static_cast<std::uint8_t>((color[k] * 255 + 50) / 100);
        }
      repeat = 1;
    }
  }
  for (const int count : drawn)
    if (count != 1) throw std::runtime_error("pixel not drawn exactly once");
  return out;
}

/// An image in half blocks, each line ended by the default colours.
inline Bitmap decoded_half_blocks(std::string drawing) {
  const auto color_of = [](const std::vector<int>& sgr, std::size_t& i) {
    std::array<int, 3> rgb{};
    if (sgr.at(i + 1) == 2) {
      rgb = {sgr.at(i + 2), sgr.at(i + 3), sgr.at(i + 4)};
      i += 5;
      return rgb;
    }
    const int number = sgr.at(i + 2);
    i += 3;
    if (number >= 232)
      return std::array<int, 3>{8 + 10 * (number - 232), 8 + 10 * (number - 232), 8 + 10 * (number - 232)};
    for (int c = 0, weight = 36; c < 3; ++c, weight /= 6) {
      const int level = (number - 16) / weight % 6;
      rgb[static_cast<std::size_t>(c)] = level == 0 ? 0 : 55 + 40 * level;
    }
    return rgb;
  };
  Bitmap out;
  drawing += "\r\n";
  for (std::size_t end; (end = drawing.find("\r\n")) != std::string::npos; drawing.erase(0, end + 2)) {
    const std::string line = drawing.substr(0, end);
    if (!line.ends_with("\033[0m")) throw std::runtime_error("colours leave the line");
    std::array<int, 3> fore{}, back{};
    std::vector<std::uint8_t> upper, lower;
    const std::regex item("\033\\[([0-9;]*)m|\u2580");
    for (std::sregex_iterator m(line.begin(), line.end(), item); m != std::sregex_iterator(); ++m) {
      if ((*m)[0] == "\u2580") {
        upper.insert(upper.end(), fore.begin(), fore.end());
        lower.insert(lower.end(), back.begin(), back.end());
        continue;
      }
      std::vector<int> sgr;
      const std::string parameters = (*m)[1];
      for (std::size_t at = 0; at <= parameters.size(); at = parameters.find(';', at) + 1) {
        sgr.push_back(std::stoi(parameters.substr(at)));
        if (parameters.find(';', at) == std::string::npos) break;
      }
      for (std::size_t i = 0; i < sgr.size();) {
        if (sgr[i] == 38) {
          fore = color_of(sgr, i);
        } else if (sgr[i] == 48) {
          back = color_of(sgr, i);
        } else {
          ++i;
        }
      }
    }
    out.width = static_cast<int>(upper.size() / 3);
    out.height += 2;
    out.codes.insert(out.codes.end(), upper.begin(), upper.end());
    out.codes.insert(out.codes.end(), lower.begin(), lower.end());
  }
  return out;
}

}  // namespace orrery::preview
