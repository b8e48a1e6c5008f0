// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "data/columns.h"
#include "data/readers.h"
#include "data/trajectory.h"

// Trajectories of GROMACS: XTC, compressed, and TRR. Both are XDR: big-endian, in units of 4 bytes.
//
// Reference  gromacs-formats
namespace orrery::data {
namespace {

using namespace std::string_view_literals;

template <class T>
T xdr_number(const std::string& bytes, std::size_t at) {
  return load<T>(bytes.data() + at, true);
}

/// Ranges of the differences between neighbouring atoms: about 2^(i/3), so that the three differences of an atom take
/// i bits. The ninth is the first in use.
constexpr std::array<std::uint32_t, 73> kRanges = {
    0,       0,       0,       0,       0,        0,        0,       0,       0,       8,       10,
    12,      16,      20,      25,      32,       40,       50,      64,      80,      101,     128,
    161,     203,     256,     322,     406,      512,      645,     812,     1024,    1290,    1625,
    2048,    2580,    3250,    4096,    5060,     6501,     8192,    10321,   13003,   16384,   20642,
    26007,   32768,   41285,   52015,   65536,    82570,    104031,  131072,  165140,  208063,  262144,
    330280,  416127,  524287,  660561,  832255,   1048576,  1321122, 1664510, 2097152, 2642245, 3329021,
    4194304, 5284491, 6658042, 8388607, 10568983, 13316085, 16777216};
constexpr int kFirstRange = 9;

__extension__ typedef unsigned __int128 Uint128;

/// Reads numbers of any number of bits, the most significant bit first.
class BitReader {
 public:
  /// Bytes behind the data that may be read; numbers that are read there are meaningless.
  static constexpr std::size_t kPadding = 128;

  /// `size`     bytes, followed by the padding
  BitReader(const char* data, std::size_t size) : data_(data), size_(size) {}

  bool is_beyond_end() const { return position_ > 8 * size_; }

  /// Domain     1 <= count <= 57
  std::uint64_t bits(unsigned count) {
    const std::uint64_t word = load<std::uint64_t>(data_ + position_ / 8, true) << (position_ % 8);
    position_ += count;
    return word >> (64 - count);
  }

  /// Reads a number of which the bytes are in order from the least significant one, and the last one has fewer bits.
  ///
  /// Domain     1 <= count <= 57
  std::uint64_t bytes(unsigned count) {
    const unsigned whole = (count - 1) / 8 * 8, rest = count - whole;
    const std::uint64_t value = bits(count);
    const std::uint64_t last = (value & ((std::uint64_t{1} << rest) - 1)) << whole;
    return whole == 0 ? last : __builtin_bswap64(value >> rest << (64 - whole)) | last;
  }

  /// Reads three numbers that are packed into one: (a * sizes[1] + b) * sizes[2] + c.
  ///
  /// `count`    bits, up to 72
  std::array<std::uint32_t, 3> three(unsigned count, const std::array<std::uint32_t, 3>& sizes) {
    constexpr unsigned kMost = 56, kFirst = 32;
    if (count <= kMost) return parts(bytes(count), sizes);
    const std::uint64_t low = bytes(kFirst);
    return parts(Uint128{bytes(count - kFirst)} << kFirst | low, sizes);
  }

 private:
  template <class Number>
  static std::array<std::uint32_t, 3> parts(Number value, const std::array<std::uint32_t, 3>& sizes) {
    const Number second = value / sizes[2], first = second / sizes[1];
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(second - first * sizes[1]),
            static_cast<std::uint32_t>(value - second * sizes[2])};
  }

  const char* data_;
  std::size_t size_, position_ = 0;  ///< bytes; bits
};

/// A position as the file stores it: integers that wrap around, since a damaged file may hold any.
using IntPosition = std::array<std::uint32_t, 3>;

IntPosition operator+(const IntPosition& a, const IntPosition& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

/// The header of compressed positions.
struct Compression {
  float precision = 0;
  IntPosition least{}, greatest{};
  int range = 0;  ///< index into kRanges
};

/// Decompresses positions. An atom is stored by its position in the box of all of them, or by the difference to the one
/// before; runs of up to ten of the latter follow the former. How many bits a difference takes changes with each run.
///
/// Result     what is wrong; empty: nothing
std::string decompress(const Compression& header, BitReader& in, std::size_t count, std::array<float*, 3> out) {
  IntPosition sizes{};
  bool is_large = false;
  constexpr std::uint32_t kLargestPacked = 0xffffff;
  for (std::size_t i = 0; i < 3; ++i) {
    sizes[i] = header.greatest[i] - header.least[i] + 1;
    if (static_cast<std::int32_t>(header.greatest[i]) < static_cast<std::int32_t>(header.least[i]) || sizes[i] == 0)
      return "the range of the coordinates is empty";
    is_large = is_large || sizes[i] > kLargestPacked;
  }
  unsigned packed_bits = 0;
  for (Uint128 product = Uint128{sizes[0]} * sizes[1] * sizes[2]; !is_large && product > 0; product >>= 1)
    ++packed_bits;
  const auto inverse = static_cast<float>(1.0 / static_cast<double>(header.precision));
  std::size_t atom = 0;
  const auto store = [&](const IntPosition& p) {
    for (std::size_t i = 0; i < 3; ++i)
      out[i][atom] = static_cast<float>(static_cast<std::int32_t>(p[i])) * inverse * kAngstromPerNm;
    ++atom;
  };
  int range = header.range;
  constexpr unsigned kRunBits = 5;
  for (std::uint32_t run = 0; atom < count;) {
    if (range < kFirstRange || range >= static_cast<int>(kRanges.size())) return "the compressed positions are damaged";
    IntPosition position;
    if (is_large)
      for (std::size_t i = 0; i < 3; ++i)
        position[i] = static_cast<std::uint32_t>(in.bits(static_cast<unsigned>(std::bit_width(sizes[i]))));
    else
      position = in.three(packed_bits, sizes);
    position = position + header.least;
    // Without a new length, the run is as long as the one before.
    int change = 0;
    if (in.bits(1) != 0) {
      run = static_cast<std::uint32_t>(in.bits(kRunBits));
      change = static_cast<int>(run % 3) - 1;
      run /= 3;
    }
    if (run + 1 > count - atom) return "the compressed positions are damaged: there are too many";
    if (run == 0) store(position);
    const std::uint32_t size = kRanges[static_cast<std::size_t>(range)], middle = size / 2;
    for (std::uint32_t i = 0; i < run; ++i) {
      const IntPosition difference = in.three(static_cast<unsigned>(range), {size, size, size});
      const IntPosition next = position + difference + IntPosition{0 - middle, 0 - middle, 0 - middle};
      // The first two atoms of a run are exchanged: water has smaller differences from oxygen to both hydrogens.
      if (i == 0) store(next);
      store(i == 0 ? position : next);
      position = next;
    }
    range += change;
    if (in.is_beyond_end()) return "truncated: the compressed positions are incomplete";
  }
  return {};
}

constexpr std::string_view kXtcMagic = "\0\0\x07\xcb"sv, kLargeXtcMagic = "\0\0\x07\xe7"sv;
/// Positions of so few atoms are not compressed.
constexpr std::uint64_t kMaxPlainAtoms = 9;

class Xtc final : public TrajectoryFile {
 public:
  explicit Xtc(const Bytes& bytes) : TrajectoryFile(bytes) {}

  Table read(int number, const std::vector<std::string>& columns) override {
    const TrajectoryFrame found = frame(number);
    if (found.rows <= kMaxPlainAtoms) return TrajectoryFile::read(number, columns);
    std::uint64_t at = found.arrays[0].layout.begin;
    const std::string head = header_bytes(at, kCompressedHeader, number);
    Compression header{xdr_number<float>(head, 0), {}, {}, xdr_number<std::int32_t>(head, 28)};
    for (std::size_t i = 0; i < 3; ++i) {
      header.least[i] = xdr_number<std::uint32_t>(head, 4 + 4 * i);
      header.greatest[i] = xdr_number<std::uint32_t>(head, 16 + 4 * i);
    }
    if (!(header.precision > 0)) fail(number, "the precision of the positions is not above 0");
    const std::uint64_t size = found.arrays[0].layout.stride;
    at = found.end - padded(size);
    std::vector<char> data(static_cast<std::size_t>(size) + BitReader::kPadding);
    bytes().read(at, static_cast<std::size_t>(size), data.data());
    Table out;
    out.rows = static_cast<std::size_t>(found.rows);
    std::array<float*, 3> to{};
    for (std::size_t i = 0; i < 3; ++i) {
      out.columns.push_back({found.arrays[0].fields[i].name, std::vector<float>(out.rows)});
      to[i] = std::get<std::vector<float>>(out.columns[i].values).data();
    }
    BitReader in(data.data(), static_cast<std::size_t>(size));
    if (const std::string fault = decompress(header, in, out.rows, to); !fault.empty()) fail(number, fault);
    return in_order(std::move(out), columns);
  }

 private:
  static constexpr std::size_t kCompressedHeader = 32;

  static std::uint64_t padded(std::uint64_t size) { return (size + 3) / 4 * 4; }

  TrajectoryFrame header(std::uint64_t begin, int number) const override {
    std::uint64_t at = begin;
    const std::string head = header_bytes(at, 56, number);
    const bool is_large = head.starts_with(kLargeXtcMagic);
    if (!is_large && !head.starts_with(kXtcMagic))
      fail(number, fmt::format("damaged: no frame of XTC begins at byte {}", begin));
    TrajectoryFrame out;
    out.rows = xdr_number<std::uint32_t>(head, 4);
    if (xdr_number<std::uint32_t>(head, 52) != out.rows) fail(number, "damaged: the numbers of atoms differ");
    out.step = xdr_number<std::int32_t>(head, 8);
    out.time_ps = static_cast<double>(xdr_number<float>(head, 12));
    std::vector<double> edges;
    for (std::size_t i = 0; i < 9; ++i)
      edges.push_back(static_cast<double>(xdr_number<float>(head, 16 + 4 * i) * kAngstromPerNm));
    out.box = box_of(edges, number);
    TrajectoryArray& array = out.arrays.emplace_back();
    array.factor = kAngstromPerNm;
    for (const char* const name : {"x", "y", "z"})
      array.fields.push_back({name, NumberType::kFloat32, 4 * array.fields.size(), true});
    array.layout = {at, 12, out.rows};
    if (out.rows <= kMaxPlainAtoms) {
      out.end = at + 12 * out.rows;
      return out;
    }
    at += kCompressedHeader;
    // Frames of more than about 300 million atoms have a size of 64 bits.
    const std::string size = header_bytes(at, is_large ? 8 : 4, number);
    array.layout.stride = is_large ? xdr_number<std::uint64_t>(size, 0) : xdr_number<std::uint32_t>(size, 0);
    // A run of ten atoms takes at least as many bits as a position and ten of the shortest differences.
    constexpr std::uint64_t kMostAtomsPerByte = 2;
    if (array.layout.stride > bytes().size() || array.layout.stride < out.rows / kMostAtomsPerByte)
      fail(number, fmt::format("truncated or damaged: {} atoms in {} bytes", out.rows, array.layout.stride));
    out.end = at + padded(array.layout.stride);
    return out;
  }
};

constexpr std::string_view kTrrMagic = "\0\0\x07\xc9\0\0\0\x0d\0\0\0\x0cGMX_trn_file"sv;

class Trr final : public TrajectoryFile {
 public:
  explicit Trr(const Bytes& bytes) : TrajectoryFile(bytes) {}

 private:
  TrajectoryFrame header(std::uint64_t begin, int number) const override {
    std::uint64_t at = begin;
    const std::string magic = header_bytes(at, kTrrMagic.size(), number);
    if (magic != kTrrMagic) fail(number, fmt::format("damaged: no frame of TRR begins at byte {}", begin));
    // The sizes of the input record, of energies, box, virial, pressure, topology and symbols, of positions, velocities
    // and forces; the numbers of atoms, of the step and of energies.
    constexpr std::size_t kNumbers = 13;
    const std::string head = header_bytes(at, 4 * kNumbers, number);
    std::array<std::uint64_t, kNumbers> n{};
    for (std::size_t i = 0; i < kNumbers; ++i) n[i] = xdr_number<std::uint32_t>(head, 4 * i);
    TrajectoryFrame out;
    out.rows = n[10];
    const std::uint64_t three = 3 * out.rows;
    const std::uint64_t size = n[2] > 0 ? n[2] / 9 : three > 0 ? std::max({n[7], n[8], n[9]}) / three : 4;
    if (size != 4 && size != 8) fail(number, fmt::format("damaged: numbers of {} bytes", size));
    const bool is_double = size == 8;
    const auto number_at = [&](const std::string& bytes, std::size_t i) {
      return is_double ? xdr_number<double>(bytes, 8 * i) : static_cast<double>(xdr_number<float>(bytes, 4 * i));
    };
    const std::string times = header_bytes(at, static_cast<std::size_t>(2 * size), number);
    out.step = static_cast<std::int32_t>(n[11]);
    out.time_ps = number_at(times, 0);
    at += n[0] + n[1];
    if (n[2] > 0) {
      const std::string box = header_bytes(at, static_cast<std::size_t>(9 * size), number);
      std::vector<double> edges;
      for (std::size_t i = 0; i < 9; ++i) edges.push_back(number_at(box, i) * static_cast<double>(kAngstromPerNm));
      out.box = box_of(edges, number);
    }
    at += n[3] + n[4] + n[5] + n[6];
    // Forces are in kJ / (mol nm).
    const std::pair<const char*, float> kArrays[] = {
        {"", kAngstromPerNm}, {"velocity", kAngstromPerNm}, {"force", 1 / kAngstromPerNm}};
    constexpr std::array<const char*, 3> kAxisNames = {"x", "y", "z"};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint64_t bytes = n[7 + i];
      if (bytes == 0 && i > 0) continue;
      if (bytes != three * size)
        fail(number, i == 0 && bytes == 0
                         ? "the frame has no positions, only velocities or forces"
                         : fmt::format("damaged: {} bytes for the vectors of {} atoms", bytes, out.rows));
      TrajectoryArray array{{at, 3 * size, out.rows}, {}, kArrays[i].second};
      for (std::size_t k = 0; k < 3; ++k)
        array.fields.push_back({i == 0 ? kAxisNames[k] : fmt::format("{}[{}]", kArrays[i].first, k + 1),
                                is_double ? NumberType::kFloat64 : NumberType::kFloat32, k * size, true});
      out.arrays.push_back(std::move(array));
      at += bytes;
    }
    out.end = at;
    return out;
  }
};

bool is_xtc(const Signature& signature) {
  return signature.head.starts_with(kXtcMagic) || signature.head.starts_with(kLargeXtcMagic);
}
bool is_trr(const Signature& signature) { return signature.head.starts_with(kTrrMagic); }

}  // namespace

const FormatReader kXtc = {"XTC", is_xtc, open_as<Xtc>};
const FormatReader kTrr = {"TRR", is_trr, open_as<Trr>};

}  // namespace orrery::data
