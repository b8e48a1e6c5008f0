// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "data/crystal.h"
#include "data/readers.h"
#include "data/trajectory.h"

// Trajectories of CHARMM, NAMD, OpenMM and LAMMPS: records of Fortran, each between two copies of its length.
namespace orrery::data {
namespace {

constexpr std::size_t kMark = 4;            ///< bytes of a length
constexpr std::uint32_t kFirstRecord = 84;  ///< its length tells the byte order
constexpr std::uint64_t kCellRecord = 48;   ///< six doubles
constexpr std::string_view kDcdName = "CORD";

bool is_dcd_of(std::string_view head, bool is_big_endian) {
  return head.size() >= kMark + kDcdName.size() && head.substr(kMark, kDcdName.size()) == kDcdName &&
         load<std::uint32_t>(head.data(), is_big_endian) == kFirstRecord;
}

/// The cell of a frame: a, gamma, b, beta, alpha, c with angles in degrees or, from NAMD, their cosines; or, from
/// CHARMM, half of a symmetric matrix, which is recognised by values that are no lengths and angles.
std::optional<Box> dcd_box(const std::array<double, 6>& v) {
  const std::array<double, 3> angles = {v[4], v[3], v[1]};
  const auto all = [&](auto is) { return std::all_of(angles.begin(), angles.end(), is); };
  std::array<double, 6> cell = {v[0], v[2], v[5], angles[0], angles[1], angles[2]};
  if (all([](double x) { return std::abs(x) <= 1; })) {
    constexpr double kRightAngle = 90;
    for (std::size_t i = 0; i < 3; ++i) cell[3 + i] = kRightAngle - std::asin(angles[i]) * 180 / std::numbers::pi;
  } else if (!all([](double x) { return x >= 0 && x <= 180; }) || v[0] < 0 || v[2] < 0 || v[5] < 0) {
    Box box;
    box.edges = {Vec3d{v[0], v[1], v[3]}, Vec3d{v[1], v[2], v[4]}, Vec3d{v[3], v[4], v[5]}};
    return box;
  }
  return cell_box(cell);
}

class Dcd final : public TrajectoryFile {
 public:
  explicit Dcd(const Bytes& bytes) : TrajectoryFile(bytes) {
    std::uint64_t at = 0;
    const std::string head = header_bytes(at, kMark + kFirstRecord + kMark, 0);
    is_big_endian_ = is_dcd_of(head, true);
    const auto setting = [&](std::size_t i) { return number_in(head, kMark + kDcdName.size() + 4 * i); };
    first_step_ = setting(1);
    steps_ = setting(2);
    // X-PLOR has no version, and other values in place of these two.
    constexpr std::size_t kFixed = 8, kHasCell = 10, kHasFourth = 11, kVersion = 19;
    has_cell_ = setting(kVersion) != 0 && setting(kHasCell) != 0;
    has_fourth_ = setting(kVersion) != 0 && setting(kHasFourth) != 0;
    if (setting(kFixed) != 0)
      Faults(bytes->file())
          .fail(0,
                fmt::format("{} atoms are fixed and only in the first frame, which is not supported", setting(kFixed)),
                "write all atoms of each frame, for example with `catdcd` or MDAnalysis");
    const std::uint64_t title = number_in(header_bytes(at, kMark, 0), 0);
    if (title > bytes->size()) Faults(bytes->file()).fail(0, "damaged: the title is longer than the file");
    at += title + kMark;
    const std::string count = header_bytes(at, 3 * kMark, 0);
    rows_ = number_in(count, kMark);
    if (number_in(count, 0) != kMark) Faults(bytes->file()).fail(0, "damaged: the number of atoms is missing");
    begin_at(at);
  }

 private:
  std::uint32_t number_in(const std::string& bytes, std::size_t at) const {
    return load<std::uint32_t>(bytes.data() + at, is_big_endian_);
  }

  TrajectoryFrame header(std::uint64_t begin, int number) const override {
    std::uint64_t at = begin;
    TrajectoryFrame out;
    out.rows = rows_;
    out.step = static_cast<double>(first_step_) + static_cast<double>(number) * static_cast<double>(steps_);
    const auto require_length = [&](std::uint64_t found, std::uint64_t expected) {
      if (found != expected) fail(number, fmt::format("damaged: a record of {} bytes instead of {}", found, expected));
    };
    if (has_cell_) {
      const std::string record = header_bytes(at, kMark + kCellRecord + kMark, number);
      require_length(number_in(record, 0), kCellRecord);
      std::array<double, 6> cell{};
      for (std::size_t i = 0; i < 6; ++i) {
        cell[i] = load<double>(record.data() + kMark + 8 * i, is_big_endian_);
        if (!std::isfinite(cell[i])) fail(number, "the box has numbers that are not finite");
      }
      out.box = dcd_box(cell);
    }
    const std::uint64_t size = 4 * rows_;
    for (const char* const name : {"x", "y", "z"}) {
      if (out.arrays.empty() || at + kMark <= bytes().size())
        require_length(number_in(header_bytes(at, kMark, number), 0), size);
      else
        at += kMark;
      out.arrays.push_back({{at, 4, rows_}, {{name, NumberType::kFloat32, 0, is_big_endian_}}});
      at += size + kMark;
    }
    out.end = at + (has_fourth_ ? size + 2 * kMark : 0);
    return out;
  }

  bool is_big_endian_ = false, has_cell_ = false, has_fourth_ = false;
  std::uint64_t rows_ = 0;
  std::uint32_t first_step_ = 0, steps_ = 0;
};

bool is_dcd(const Signature& signature) { return is_dcd_of(signature.head, false) || is_dcd_of(signature.head, true); }

}  // namespace

const FormatReader kDcd = {"DCD", is_dcd, open_as<Dcd>};

}  // namespace orrery::data
