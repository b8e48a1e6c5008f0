// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/text.h"
#include "data/atom_elements.h"
#include "data/atom_table.h"
#include "data/bonds.h"
#include "data/crystal.h"
#include "data/elements.h"
#include "data/readers.h"
#include "data/text_lines.h"

namespace orrery::data {

namespace {

/// Reads the biological assemblies in REMARK 350 of a PDB file. Values are separated by spaces, not by column: serial
/// numbers of transforms above 999 overflow their columns and shift those to the right.
///
/// Reference  pdb-format
class BiomtReader {
 public:
  /// Takes the text of a line after "REMARK 350".
  ///
  /// Errors     base::Error(kBadData): malformed or incomplete transforms
  void take(std::string_view text, std::uint64_t line, Faults& faults) {
    text = trimmed(text);
    constexpr std::string_view kName = "BIOMOLECULE:", kChains = "CHAINS:", kRow = "BIOMT";
    if (text.starts_with(kName)) {
      assemblies_.push_back({std::string(trimmed(text.substr(kName.size()))), {}});
    } else if (const std::size_t at = text.find(kChains); at != std::string_view::npos) {
      if (text.starts_with("APPLY")) {
        part();
        auto& parts = assemblies_.back().parts;
        if (!parts.back().chains.empty() || !parts.back().transforms.empty()) parts.emplace_back();
      }
      for (const std::string_view name : words_of(text.substr(at + kChains.size()), ", \t"))
        part().chains.emplace_back(name);
    } else if (text.starts_with(kRow)) {
      const std::vector<std::string_view> words = words_of(text);
      const std::size_t row = static_cast<std::size_t>(row_);
      double values[4];
      bool is_good = words.size() == 6;
      for (std::size_t i = 0; i < 4 && is_good; ++i)
        is_good = base::from_text(words[2 + i], values[i]) && std::isfinite(values[i]);
      if (!is_good) faults.fail(line, "malformed BIOMT row: expected a serial number and four numbers");
      if (words[0] != "BIOMT" + std::to_string(row + 1) || (row > 0 && words[1] != serial_))
        faults.fail(line, fmt::format("BIOMT row out of order: expected row {}{}", row + 1,
                                      row > 0 ? " of transform " + serial_ : " of a transform"));
      serial_ = words[1];
      transform_.rows[row] = {values[0], values[1], values[2]};
      (row == 0   ? transform_.translation.x
       : row == 1 ? transform_.translation.y
                  : transform_.translation.z) = values[3];
      row_ = (row_ + 1) % 3;
      if (row_ == 0) part().transforms.push_back(transform_);
    }
  }

  /// Returns the assemblies after the last line.
  std::vector<Assembly> finish(Faults& faults) {
    if (row_ != 0) faults.fail(0, fmt::format("truncated: transform {} of REMARK 350 is incomplete", serial_));
    return std::move(assemblies_);
  }

 private:
  /// The part that the next transform belongs to.
  AssemblyPart& part() {
    if (assemblies_.empty()) assemblies_.push_back({"1", {}});
    if (assemblies_.back().parts.empty()) assemblies_.back().parts.emplace_back();
    return assemblies_.back().parts.back();
  }

  std::vector<Assembly> assemblies_;
  Transform transform_;
  int row_ = 0;  ///< number of rows of `transform_` that have been read
  std::string serial_;
};

/// Location of a model in a PDB file.
struct PdbModel {
  std::uint64_t begin = 0, end = 0;  ///< offsets
  std::uint64_t first_line = 1;
  std::optional<double> number;  ///< from its MODEL record
  std::string cell;              ///< the CRYST1 record that applies to it; may be empty
  std::uint64_t atoms = 0;       ///< number of their records
};

/// The models and assemblies of a PDB file.
struct PdbIndex {
  std::vector<PdbModel> models;  ///< at least one
  std::vector<Assembly> assemblies;
  std::string title;
  PdbModel rest;                  ///< what follows the last model
  std::uint64_t connections = 0;  ///< number of CONECT records
  bool is_left_aligned = false;   ///< see AtomElements
  std::set<std::string> two_letter_chains;
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// AMBER and CHARMM begin serial numbers of six and seven digits in the columns of the record's name: "ATOM 100000".
bool is_pdb_atom(std::string_view line) {
  const auto may_follow = [](char c) { return c == ' ' || is_digit(c); };
  return line.starts_with("HETATM") ||
         (line.starts_with("ATOM") && line.size() > 5 && may_follow(line[4]) && may_follow(line[5]));
}

constexpr std::string_view kConnection = "CONECT";

constexpr std::size_t kMaxLine = 120;
constexpr std::size_t kMaxTitle = 1000;
/// Columns of a record, of its name, and of a residue number.
constexpr std::size_t kRecordWidth = 80, kRecordName = 6, kResidueWidth = 4;

/// The text in a range of a record's columns, 1-based and inclusive, without surrounding spaces.
std::string_view columns(std::string_view line, std::size_t first, std::size_t last) {
  return trimmed(line.substr(std::min(first - 1, line.size()), last - first + 1));
}

/// The character in a column, 1-based.
char column(std::string_view line, std::size_t number) { return number <= line.size() ? line[number - 1] : ' '; }

/// A CONECT record has the serial number of an atom, and of up to four that are bonded to it; each has five columns.
constexpr std::size_t kMaxBonded = 4, kSerialWidth = 5;

/// Columns 31 to 54 hold the coordinates.
constexpr std::size_t kCoordinateColumn = 31, kCoordinateWidth = 8, kShortestAtom = 54;

/// The fields of an atom's record. Programs that print numbers with "%5d" and "%4d" shift the rest of the line to the
/// right where a serial number has six digits, or a residue number five; others write such a number into the column
/// behind the field, which is blank or holds the insertion code, and shift nothing. The decimal points tell.
class AtomRecord {
 public:
  explicit AtomRecord(std::string_view line) : line_(line) {
    std::size_t more = 0;  // digits of the serial number that its columns cannot hold
    while (is_digit(column(line, kSerialEnd)) && is_digit(column(line, kSerialEnd + 1 + more))) ++more;
    serial_end_ = kSerialEnd + std::min<std::size_t>(more, 1);
    for (const std::size_t by_serial : {std::size_t{0}, more})
      for (const std::size_t by_residue : {std::size_t{0}, std::size_t{1}})
        if (has_points(by_serial + by_residue) && (by_residue == 0 || has_wide_residue_number(by_serial))) {
          if (by_serial > 0) serial_end_ = kSerialEnd + by_serial;
          serial_shift_ = by_serial;
          shift_ = by_serial + by_residue;
          is_exact_ = true;
          return;
        }
  }

  std::string_view serial() const {
    return columns(line_, is_digit(column(line_, 5)) ? 5 : is_digit(column(line_, 6)) ? 6 : 7, serial_end_);
  }
  /// The four columns of the name, whose alignment matters.
  std::string_view name() const { return line_.substr(12 + serial_shift_, 4); }
  char altloc() const { return column(line_, 17 + serial_shift_); }
  /// Residue name of three letters, and two columns that it shares with the chain.
  std::string_view short_residue() const { return columns(line_, 18 + serial_shift_, 20 + serial_shift_); }
  std::string_view long_residue() const { return columns(line_, 18 + serial_shift_, 21 + serial_shift_); }
  char fourth_letter() const { return column(line_, 21 + serial_shift_); }
  std::string_view chain() const { return columns(line_, 22 + serial_shift_, 22 + serial_shift_); }
  std::string_view long_chain() const { return columns(line_, 21 + serial_shift_, 22 + serial_shift_); }

  /// Four columns, or five digits.
  std::string_view residue_number() const {
    return columns(line_, 23 + serial_shift_, (has_wide_residue_number(serial_shift_) ? 27 : 26) + serial_shift_);
  }
  std::string_view insertion() const {
    return has_wide_residue_number(serial_shift_) ? "" : columns(line_, 27 + shift_, 27 + shift_);
  }

  /// Result     false if one of the fields is not a number
  bool read_position(Vec3d& out) const {
    // A line that is shifted for another reason may look like numbers of two decimal places.
    if (!is_exact_ && has_points(1) && is_digit(column(line_, kShortestAtom + 1))) return false;
    double values[3];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t first = kCoordinateColumn + shift_ + i * kCoordinateWidth;
      if (!base::from_text(columns(line_, first, first + kCoordinateWidth - 1), values[i])) return false;
    }
    out = {values[0], values[1], values[2]};
    return true;
  }

  /// A number that may be missing or, where it is too large for its columns, asterisks.
  double occupancy() const { return number(55, 60, 1); }
  double b_factor() const { return number(61, 66, 0); }
  /// Of CHARMM, NAMD and X-PLOR.
  std::string_view segment() const { return columns(line_, 73 + shift_, 76 + shift_); }
  /// Empty if it is missing: files of before 1996 have a line number there.
  std::string_view element() const {
    const std::string_view out = columns(line_, 77 + shift_, 78 + shift_);
    return std::any_of(out.begin(), out.end(), is_letter) ? out : std::string_view();
  }

 private:
  static constexpr std::size_t kSerialEnd = 11;  ///< last column of a serial number

  /// Whether coordinates with three decimal places would be in these columns.
  bool has_points(std::size_t shift) const {
    for (const std::size_t at : {35, 43, 51}) {
      if (column(line_, at + shift) != '.') return false;
      for (std::size_t digit = 1; digit <= 3; ++digit)
        if (!is_digit(column(line_, at + shift + digit))) return false;
    }
    return true;
  }

  bool has_wide_residue_number(std::size_t shift) const {
    const std::string_view number = columns(line_, 23 + shift, 27 + shift);
    return number.size() == 5 && std::all_of(number.begin(), number.end(), is_digit);
  }

  double number(std::size_t first, std::size_t last, double otherwise) const {
    const std::string_view text = columns(line_, first + shift_, last + shift_);
    return text.empty() ? otherwise : base::number_of<double>(text).value_or(std::nan(""));
  }

  std::string_view line_;
  std::size_t serial_end_ = kSerialEnd;
  std::size_t serial_shift_ = 0;  ///< of what follows the serial number
  std::size_t shift_ = 0;         ///< of what follows the residue number
  bool is_exact_ = false;         ///< the coordinates have three decimal places
};

class Indexer {
 public:
  explicit Indexer(Faults& faults) : faults_(faults) {}

  void take(std::string_view line, std::uint64_t offset) {
    ++line_;
    // Other characters are common in the text of remarks and titles.
    const bool is_atom = is_pdb_atom(line);
    const std::string_view record = line.substr(0, is_atom ? kRecordWidth : kRecordName);
    if (std::any_of(record.begin(), record.end(), [](char c) { return static_cast<unsigned char>(c) > 0x7e; }))
      faults_.add_of_many(line_, "the record has characters that are not ASCII");
    if (is_atom) {
      ++model_.atoms;
      ++atoms_;
      has_end_ = false;
      if (line.size() >= kShortestAtom) note_conventions(AtomRecord(line));
    } else if (line.starts_with("MODEL ")) {
      finish(offset, line_);
      is_declared_ = true;
      model_.number = base::number_of<int>(columns(line, 7, 14));
    } else if (line.starts_with("END") && (line.starts_with("ENDMDL") || columns(line, 4, 6).empty())) {
      finish(offset, line_);
      has_end_ = !line.starts_with("ENDMDL");
    } else if (line.starts_with("HEADER")) {
      has_header_ = true;
    } else if (line.starts_with("MASTER")) {
      declared_atoms_ = base::number_of<std::uint64_t>(columns(line, 51, 55));
    } else if (line.starts_with("CRYST1")) {
      model_.cell = line;
    } else if (line.starts_with("TITLE ") && index_.title.size() < kMaxTitle) {
      index_.title.append(index_.title.empty() ? "" : " ").append(columns(line, 11, 80));
    } else if (line.starts_with(kConnection)) {
      ++index_.connections;
    } else if (line.starts_with("REMARK 350")) {
      biomt_.take(line.substr(10), line_, faults_);
    }
  }

  PdbIndex finish_file(std::uint64_t size) {
    faults_.raise_if_any();
    const bool has_all_atoms = declared_atoms_ && *declared_atoms_ == atoms_;
    if (has_header_ && !has_end_ && !has_all_atoms)
      faults_.fail(line_, "truncated: the file has HEADER, but not the record END",
                   "download the file again; if it is complete, add a line END");
    finish(size, line_);
    index_.rest = model_;
    index_.rest.end = size;
    if (index_.models.empty()) index_.models.push_back({0, 0, 1, std::nullopt, {}});
    index_.assemblies = biomt_.finish(faults_);
    return std::move(index_);
  }

 private:
  /// Ends the current model, unless it is only what precedes the first one or follows the last.
  void finish(std::uint64_t end, std::uint64_t line) {
    if (model_.atoms == 0 && !is_declared_) return;
    model_.end = end;
    index_.models.push_back(model_);
    // The next model has the same cell unless it declares its own.
    model_ = {end, end, line, std::nullopt, model_.cell};
    is_declared_ = false;
  }

  /// What only the atoms of standard residues tell: in others, "CA  " may be calcium, and "POPCA" the residue POPC of
  /// chain A, or POP of chain CA.
  void note_conventions(const AtomRecord& atom) {
    const bool may_have_long_chain = atom.fourth_letter() != ' ';
    if (!may_have_long_chain && (index_.is_left_aligned || !atom.element().empty())) return;
    if (!is_standard_residue(atom.short_residue())) return;
    if (may_have_long_chain && !is_standard_residue(atom.long_residue()) && !atom.chain().empty())
      index_.two_letter_chains.emplace(atom.long_chain());
    const std::string_view name = atom.name();
    if (atom.element().empty() && is_letter(name[0]) && name[3] == ' ' && !name.starts_with("SE"))
      index_.is_left_aligned = true;
  }

  PdbIndex index_;
  Faults& faults_;
  BiomtReader biomt_;
  PdbModel model_;
  bool is_declared_ = false;  ///< by a MODEL record
  bool has_header_ = false;
  bool has_end_ = false;                         ///< after the last atom
  std::uint64_t atoms_ = 0;                      ///< records
  std::optional<std::uint64_t> declared_atoms_;  ///< by the MASTER record
  std::uint64_t line_ = 0;
};

/// Calls `take` with each line in a range of the file, without line ending, and the line's offset. Lines are truncated
/// to 120 bytes, more than a PDB record can have.
///
/// `check`    called with all bytes, block by block
void for_each_pdb_line(const ByteSource& bytes, std::uint64_t begin, std::uint64_t end,
                       const std::function<void(std::string_view line, std::uint64_t offset)>& take,
                       const std::function<void(std::string_view block)>& check = {}) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  const auto cut = [](std::string_view line) {
    line = line.substr(0, kMaxLine);
    return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
  };
  std::string rest;  // of a line that continues in the next block
  std::uint64_t line_begin = begin;
  for (std::uint64_t at = begin; at < end; at += kBlock) {
    const std::string block = bytes.text(at, static_cast<std::size_t>(std::min<std::uint64_t>(kBlock, end - at)));
    if (check) check(block);
    std::string_view left = block;
    for (std::size_t length; (length = left.find('\n')) != std::string_view::npos; left.remove_prefix(length + 1)) {
      if (rest.empty()) {
        take(cut(left.substr(0, length)), line_begin);
      } else {
        rest += left.substr(0, length).substr(0, kMaxLine);
        take(cut(rest), line_begin);
        rest.clear();
      }
      line_begin = at + block.size() - left.size() + length + 1;
    }
    if (rest.size() < kMaxLine) rest += left.substr(0, kMaxLine);
  }
  if (line_begin < end) take(cut(rest), line_begin);
}

/// Finds the models of a PDB file, which end at ENDMDL or END, and its assemblies.
///
/// Errors     base::Error(kBadData): malformed REMARK 350; a file that begins with HEADER, as those of the Protein Data
///            Bank do, but has neither END nor as many atoms as MASTER declares, so it is truncated. Simulation
///            programs write neither record
/// Cost       one pass over the file
PdbIndex index_pdb(const ByteSource& bytes) {
  Faults faults(bytes.file());
  Indexer indexer(faults);
  std::uint64_t line = 1;
  for_each_pdb_line(
      bytes, 0, bytes.size(), [&](std::string_view text, std::uint64_t offset) { indexer.take(text, offset); },
      [&](std::string_view block) { require_text(block, line, faults); });
  return indexer.finish_file(bytes.size());
}

/// Reads a number of atoms or residues that is wider than its columns: with hybrid-36, A0000 follows 99999; VMD goes on
/// in hexadecimal, 186a0.
std::optional<std::int64_t> wide_number(std::string_view word, std::size_t width) {
  std::int64_t value = 0;
  if (base::from_text(word, value)) return value;
  const bool is_hybrid = word.size() == width && word[0] >= 'A' && word[0] <= 'Z';
  if (!base::from_text(word, value, is_hybrid ? 36 : 16)) return std::nullopt;
  if (!is_hybrid) return value;
  std::int64_t first = 10, decimal = 1;  // of the numbers that begin with a letter
  for (std::size_t i = 0; i < width; ++i, decimal *= 10)
    if (i > 0) first *= 36;
  return value - first + decimal;
}

class PdbReader final : public DataFile {
 public:
  PdbReader(const Bytes& bytes, const OpenOptions& options)
      : bytes_(bytes), index_(index_pdb(*bytes)), memory_limit_(options.memory_limit) {}

  int frame_count() override { return static_cast<int>(index_.models.size()); }

  std::uint64_t memory() const override {
    return bytes_->memory() + atoms_.memory() + serials_.size() * sizeof(serials_[0]);
  }

  FrameInfo describe(int frame) override {
    load(frame);
    FrameInfo info = atoms_.info();
    info.box = box_;
    info.assemblies = index_.assemblies;
    info.step = index_.models[static_cast<std::size_t>(frame)].number;
    info.title = index_.title;
    info.bonds = index_.connections * kMaxBonded;
    info.has_bonds = index_.connections > 0;
    info.lists_all_bonds = false;
    if (const std::string warning = elements_.warning(); !warning.empty()) info.warnings.push_back(warning);
    return info;
  }

  Table read(int frame, const std::vector<std::string>& columns) override {
    load(frame);
    return atoms_.table(columns);
  }

  /// Programs that remove or renumber atoms often leave the CONECT records as they were.
  std::vector<Bond> bonds(int frame, std::vector<std::string>& warnings) override {
    if (index_.connections == 0) return {};
    load(frame);
    Faults faults(bytes_->file());
    BondsById out(serials_, faults);
    if (has_wide_serials_) {
      warnings.emplace_back(
          "the bonds of the file were left out: CONECT has no columns for serial numbers of six digits");
      return {};
    }
    // Records within a model belong to it, those after the last model to all.
    for (const PdbModel& part : {index_.models[static_cast<std::size_t>(frame)], index_.rest}) {
      std::uint64_t line_number = part.first_line - 1;
      for_each_pdb_line(*bytes_, part.begin, part.end, [&](std::string_view line, std::uint64_t) {
        ++line_number;
        if (!line.starts_with(kConnection)) return;
        std::optional<std::int64_t> from;
        for (std::size_t i = 0; i <= kMaxBonded; ++i) {
          const std::size_t column = kRecordName + 1 + i * kSerialWidth;
          const std::string_view word = columns(line, column, column + kSerialWidth - 1);
          if (word.empty()) continue;
          const std::optional<std::int64_t> serial = wide_number(word, kSerialWidth);
          if (!serial)
            faults.add_of_many(line_number, fmt::format("{} is not the serial number of an atom", quoted_word(word)));
          else if (i == 0)
            from = serial;
          else if (from)
            out.add(*from, *serial, line_number);
        }
      });
    }
    warn_of_missing(faults, warnings);
    return out.take();
  }

 private:
  void load(int frame) {
    if (frame == loaded_) return;
    loaded_ = -1;
    atoms_ = {};
    serials_.clear();
    has_wide_serials_ = false;
    elements_ = AtomElements(index_.is_left_aligned);
    const PdbModel& model = index_.models[static_cast<std::size_t>(frame)];
    const bool has_bonds = index_.connections > 0;
    require_parse_memory(bytes_->file(), model.atoms, AtomTable::kBytesPerRow + (has_bonds ? sizeof(serials_[0]) : 0),
                         bytes_->memory(), memory_limit_);
    atoms_.reserve(static_cast<std::size_t>(model.atoms));
    if (has_bonds) serials_.reserve(static_cast<std::size_t>(model.atoms));
    set_box(model.cell);
    Faults faults(bytes_->file());
    std::uint64_t line_number = model.first_line - 1;
    for_each_pdb_line(*bytes_, model.begin, model.end, [&](std::string_view line, std::uint64_t) {
      ++line_number;
      if (!is_pdb_atom(line)) return;
      if (line.size() < kShortestAtom)
        faults.add_of_many(line_number, "truncated atom: the line ends before column 54");
      else if (!take_atom(line))
        faults.add_of_many(line_number, "malformed coordinates in columns 31 to 54");
    });
    faults.raise_if_any();
    loaded_ = frame;
  }

  /// Result     false if the coordinates are malformed
  bool take_atom(std::string_view line) {
    const AtomRecord record(line);
    Atom atom;
    if (!record.read_position(atom.position)) return false;
    set_residue(record, atom);
    atom.record = trimmed(line.substr(0, line[0] == 'A' ? 4 : kRecordName));
    atom.b_factor = record.b_factor();
    atom.occupancy = record.occupancy();
    const std::string_view listed = record.element();
    const Element* const element = find_element(listed);
    atom.element = listed == "D" || listed == "X" ? listed  // deuterium, and atoms that are none
                   : element != nullptr           ? element->symbol
                                                  : elements_.element_of(record.name(), atom.residue);
    atom.name = trimmed(record.name());
    const char altloc = record.altloc();
    if (altloc != ' ') atom.altloc = {&altloc, 1};
    atom.segment = record.segment();
    const std::size_t row = atoms_.add(atom);
    if (index_.connections == 0) return true;
    const std::string_view serial = record.serial();
    has_wide_serials_ = has_wide_serials_ || serial.size() > kSerialWidth;
    if (const auto number = wide_number(serial, kSerialWidth))
      serials_.emplace_back(*number, static_cast<std::uint32_t>(row));
    return true;
  }

  /// CHARMM, NAMD and VMD write residues of four letters, "POPCA", into a column that others use for chains of two.
  /// Such a chain has standard residues, too.
  void set_residue(const AtomRecord& record, Atom& atom) const {
    const bool is_long = record.fourth_letter() != ' ';
    const bool has_long_chain =
        is_long && !record.chain().empty() && index_.two_letter_chains.contains(std::string(record.long_chain()));
    atom.residue = is_long && !has_long_chain ? record.long_residue() : record.short_residue();
    atom.chain = has_long_chain ? record.long_chain() : record.chain();
    atom.residue_number = static_cast<std::int32_t>(wide_number(record.residue_number(), kResidueWidth).value_or(0));
    atom.has_residue_number = !record.residue_number().empty();
    atom.insertion = record.insertion();
  }

  /// The cell is a simulation box only without crystal symmetry; otherwise, it contains more than the atoms of the
  /// file.
  void set_box(std::string_view record) {
    box_.reset();
    const std::string_view group = columns(record, 56, 66);
    if (record.empty() || (group != "P 1" && !group.empty())) return;
    std::array<double, 6> cell{};
    constexpr std::size_t kFirst[] = {7, 16, 25, 34, 41, 48, 55};
    for (std::size_t i = 0; i < 6; ++i)
      if (!base::from_text(columns(record, kFirst[i], kFirst[i + 1] - 1), cell[i])) return;
    // Programs write a cell of zeros for structures without one.
    box_ = cell_box(cell);
  }

  Bytes bytes_;
  PdbIndex index_;
  std::uint64_t memory_limit_;  ///< see OpenOptions
  int loaded_ = -1;             ///< frame in `atoms_`
  AtomTable atoms_;
  AtomElements elements_;
  std::optional<Box> box_;
  std::vector<std::pair<std::int64_t, std::uint32_t>> serials_;  ///< serial number and row of the atoms, for bonds
  bool has_wide_serials_ = false;                                ///< of more digits than CONECT has columns
};

bool is_pdb(const Signature& signature) {
  // Its columns are not those of PDB: a charge and a radius.
  if (signature.head.empty() || signature.extension == ".pqr") return false;
  constexpr std::array<std::string_view, 18> kRecords = {"HEADER", "OBSLTE", "TITLE ", "SPLIT ", "CAVEAT", "COMPND",
                                                         "SOURCE", "KEYWDS", "EXPDTA", "NUMMDL", "MDLTYP", "AUTHOR",
                                                         "REVDAT", "REMARK", "CRYST1", "ORIGX1", "SCALE1", "MODEL "};
  const auto is_record = [&](std::string_view text) {
    return is_pdb_atom(text) ||
           std::any_of(kRecords.begin(), kRecords.end(), [&](std::string_view r) { return text.starts_with(r); });
  };
  const std::string_view text = signature.head;
  if (signature.extension == ".pdb" || signature.extension == ".ent")
    return is_record(text) || text.find("\nATOM  ") != text.npos || text.find("\nHETATM") != text.npos;
  // Any text file may begin with one such word, so the first two lines must be records.
  const std::string_view second = text.substr(std::min(text.find('\n'), text.size() - 1) + 1);
  return is_record(text) && (second.empty() || is_record(second) || second.starts_with("TER") ||
                             second.starts_with("END") || second.starts_with("ANISOU"));
}

}  // namespace

const FormatReader kPdb = {"PDB", is_pdb, open_as<PdbReader>};

}  // namespace orrery::data
