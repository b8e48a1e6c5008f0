// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <gemmi/pdb.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/text.h"
#include "data/atom_table.h"
#include "data/bonds.h"
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
};

/// The models and assemblies of a PDB file.
struct PdbIndex {
  std::vector<PdbModel> models;  ///< at least one
  std::vector<Assembly> assemblies;
  std::string title;
  PdbModel rest;                  ///< what follows the last model
  std::uint64_t connections = 0;  ///< number of CONECT records
};

inline bool is_pdb_atom(std::string_view line) { return line.starts_with("ATOM  ") || line.starts_with("HETATM"); }

constexpr std::string_view kConnection = "CONECT";

constexpr std::size_t kMaxLine = 120;
constexpr std::size_t kMaxTitle = 1000;
/// Columns of a record, and of its name.
constexpr std::size_t kRecordWidth = 80, kRecordName = 6;

/// The text in a range of a record's columns, 1-based and inclusive, without surrounding spaces.
std::string columns(std::string_view line, std::size_t first, std::size_t last) {
  return std::string(trimmed(line.substr(std::min(first - 1, line.size()), last - first + 1)));
}

class Indexer {
 public:
  explicit Indexer(Faults& faults) : faults_(faults) {}

  void take(std::string_view line, std::uint64_t offset) {
    ++line_;
    // Other characters are common in the text of remarks and titles.
    const std::string_view record = line.substr(0, is_pdb_atom(line) ? kRecordWidth : kRecordName);
    if (std::any_of(record.begin(), record.end(), [](char c) { return static_cast<unsigned char>(c) > 0x7e; }))
      faults_.add_of_many(line_, "the record has characters that are not ASCII");
    if (is_pdb_atom(line)) {
      has_atoms_ = true;
      ++atoms_;
      has_end_ = false;
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
      index_.title += (index_.title.empty() ? "" : " ") + columns(line, 11, 80);
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
    if (!has_atoms_ && !is_declared_) return;
    model_.end = end;
    index_.models.push_back(model_);
    // The next model has the same cell unless it declares its own.
    model_ = {end, end, line, std::nullopt, model_.cell};
    has_atoms_ = is_declared_ = false;
  }

  PdbIndex index_;
  Faults& faults_;
  BiomtReader biomt_;
  PdbModel model_;
  bool has_atoms_ = false;
  bool is_declared_ = false;  ///< by a MODEL record
  bool has_header_ = false;
  bool has_end_ = false;                         ///< after the last atom
  std::uint64_t atoms_ = 0;                      ///< records
  std::optional<std::uint64_t> declared_atoms_;  ///< by the MASTER record
  std::uint64_t line_ = 0;
};

/// Calls `take` with each line in a range of the file, without line ending, and the line's offset. Lines are truncated
/// to 120 bytes, more than a PDB record can have.
void for_each_pdb_line(const ByteSource& bytes, std::uint64_t begin, std::uint64_t end,
                       const std::function<void(std::string_view line, std::uint64_t offset)>& take) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  const auto cut = [](std::string_view line) {
    line = line.substr(0, kMaxLine);
    return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
  };
  std::string rest;  // of a line that continues in the next block
  std::uint64_t line_begin = begin;
  for (std::uint64_t at = begin; at < end; at += kBlock) {
    const std::string block = bytes.text(at, static_cast<std::size_t>(std::min<std::uint64_t>(kBlock, end - at)));
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
  require_text(bytes, faults);
  Indexer indexer(faults);
  for_each_pdb_line(bytes, 0, bytes.size(),
                    [&](std::string_view line, std::uint64_t offset) { indexer.take(line, offset); });
  return indexer.finish_file(bytes.size());
}

/// Columns 31 to 54 hold the coordinates.
constexpr std::size_t kCoordinateColumn = 30, kCoordinateWidth = 8, kShortestAtom = 54;
/// The columns after the element are not read: charges are often misplaced.
constexpr std::size_t kLastColumn = 78;

/// gemmi reads malformed coordinates as 0.
bool has_coordinates(std::string_view line) {
  for (std::size_t i = 0; i < 3; ++i) {
    std::string_view field = line.substr(kCoordinateColumn + i * kCoordinateWidth, kCoordinateWidth);
    field.remove_prefix(std::min(field.find_first_not_of(' '), field.size()));
    field = field.substr(0, field.find(' '));
    double value = 0;
    if (!base::from_text(field, value)) return false;
  }
  return true;
}

/// A CONECT record has the serial number of an atom, and of up to four that are bonded to it; each has five columns.
constexpr std::size_t kMaxBonded = 4, kSerialWidth = 5;

/// Reads a serial number. In the hybrid-36 encoding, A0000 follows 99999.
std::optional<std::int64_t> serial_number(std::string_view word) {
  constexpr std::int64_t kFirst = 10 * 36 * 36 * 36 * 36, kFirstSerial = 100'000;
  const bool is_hybrid = word[0] >= 'A' && word.size() == kSerialWidth;
  std::int64_t value = 0;
  if (!base::from_text(word, value, is_hybrid ? 36 : 10)) return std::nullopt;
  return is_hybrid ? value - kFirst + kFirstSerial : value;
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
    FrameInfo info = atoms_.info(false);
    info.box = box_;
    info.assemblies = index_.assemblies;
    info.step = index_.models[static_cast<std::size_t>(frame)].number;
    info.title = index_.title;
    info.bonds = index_.connections * kMaxBonded;
    info.lists_all_bonds = false;
    return info;
  }

  Table read(int frame, const std::vector<std::string>& columns) override {
    load(frame);
    return atoms_.table(columns);
  }

  std::vector<Bond> bonds(int frame) override {
    if (index_.connections == 0) return {};
    load(frame);
    Faults faults(bytes_->file());
    BondsById out(serials_, faults);
    // Records within a model belong to it, those after the last model to all.
    for (const PdbModel& part : {index_.models[static_cast<std::size_t>(frame)], index_.rest}) {
      std::uint64_t line_number = part.first_line - 1;
      for_each_pdb_line(*bytes_, part.begin, part.end, [&](std::string_view line, std::uint64_t) {
        ++line_number;
        if (!line.starts_with(kConnection)) return;
        std::optional<std::int64_t> from;
        for (std::size_t i = 0; i <= kMaxBonded; ++i) {
          const std::size_t column = kRecordName + 1 + i * kSerialWidth;
          const std::string word = columns(line, column, column + kSerialWidth - 1);
          if (word.empty()) continue;
          const std::optional<std::int64_t> serial = serial_number(word);
          if (!serial)
            faults.add_of_many(line_number, fmt::format("{} is not the serial number of an atom", quoted_word(word)));
          else if (i == 0)
            from = serial;
          else if (from)
            out.add(*from, *serial, line_number);
        }
      });
    }
    return out.take();
  }

 private:
  /// Returns the cell and the atoms of a model, the records that gemmi has to read, checked.
  std::string text_of(const PdbModel& model) {
    std::string text = model.cell.empty() ? "" : model.cell + '\n';
    std::uint64_t line_number = model.first_line - 1;
    Faults faults(bytes_->file());
    for_each_pdb_line(*bytes_, model.begin, model.end, [&](std::string_view line, std::uint64_t) {
      ++line_number;
      if (!is_pdb_atom(line)) return;
      if (line.size() < kShortestAtom)
        faults.add_of_many(line_number, "truncated atom: the line ends before column 54");
      else if (!has_coordinates(line))
        faults.add_of_many(line_number, "malformed coordinates in columns 31 to 54");
      else
        text.append(line.substr(0, kLastColumn)) += '\n';
    });
    faults.raise_if_any();
    return text;
  }

  void load(int frame) {
    if (frame == loaded_) return;
    loaded_ = -1;
    atoms_ = {};
    serials_.clear();
    const PdbModel& model = index_.models[static_cast<std::size_t>(frame)];
    // Measured: 3.7 with residues of 8 atoms, 5.5 if all are water.
    constexpr double kMemoryPerByte = 5.5;
    require_parse_memory(bytes_->file(), model.end - model.begin, kMemoryPerByte, bytes_->memory(), memory_limit_);
    const std::string text = text_of(model);
    gemmi::Structure structure;
    try {
      structure = gemmi::read_pdb_from_memory(text.data(), text.size(), bytes_->file().string());
    } catch (const std::exception& error) {
      Faults(bytes_->file()).fail(model.first_line, error.what());
    }
    set_box(structure);
    Atom atom;
    for (const gemmi::Chain& chain : structure.models.at(0).chains) {
      atom.chain = chain.name;
      for (const gemmi::Residue& residue : chain.residues) {
        atom.residue = residue.name;
        atom.residue_number = residue.seqid.num.has_value() ? *residue.seqid.num : 0;
        atom.insertion = residue.seqid.icode;
        atom.record = residue.het_flag == 'H' ? "HETATM" : "ATOM";
        for (const gemmi::Atom& source : residue.atoms) {
          atom.position = {source.pos.x, source.pos.y, source.pos.z};
          atom.b_factor = static_cast<double>(source.b_iso);
          atom.occupancy = static_cast<double>(source.occ);
          atom.element = source.element.name();
          atom.name = source.name;
          atom.altloc = source.altloc == '\0' ? std::string() : std::string(1, source.altloc);
          const std::size_t row = atoms_.add(atom);
          if (index_.connections > 0) serials_.emplace_back(source.serial, static_cast<std::uint32_t>(row));
        }
      }
    }
    loaded_ = frame;
  }

  /// The cell is a simulation box only without crystal symmetry; otherwise, it contains more than the atoms of the
  /// file.
  void set_box(const gemmi::Structure& structure) {
    box_.reset();
    const bool has_symmetry = structure.spacegroup_hm != "P 1" && !structure.spacegroup_hm.empty();
    // Programs write a cell of zeros for structures without one.
    if (has_symmetry || !structure.cell.is_crystal() || !(structure.cell.volume > 0)) return;
    Box box;
    for (int i = 0; i < 3; ++i) {
      const gemmi::Vec3 edge = structure.cell.orth.mat.column_copy(i);
      box.edges[static_cast<std::size_t>(i)] = {edge.x, edge.y, edge.z};
      if (!math::is_finite(box.edges[static_cast<std::size_t>(i)])) return;
    }
    box_ = box;
  }

  Bytes bytes_;
  PdbIndex index_;
  std::uint64_t memory_limit_;  ///< see OpenOptions
  int loaded_ = -1;             ///< frame in `atoms_`
  AtomTable atoms_;
  std::optional<Box> box_;
  std::vector<std::pair<std::int64_t, std::uint32_t>> serials_;  ///< serial number and row of the atoms, for bonds
};

bool is_pdb(const Signature& signature) {
  // Its columns are not those of PDB: a charge and a radius.
  if (signature.head.empty() || signature.extension == ".pqr") return false;
  constexpr std::array<std::string_view, 20> kRecords = {
      "HEADER", "OBSLTE", "TITLE ", "SPLIT ", "CAVEAT", "COMPND", "SOURCE", "KEYWDS", "EXPDTA", "NUMMDL",
      "MDLTYP", "AUTHOR", "REVDAT", "REMARK", "CRYST1", "ORIGX1", "SCALE1", "MODEL ", "ATOM  ", "HETATM"};
  const auto is_record = [&](std::string_view text) {
    return std::any_of(kRecords.begin(), kRecords.end(), [&](std::string_view r) { return text.starts_with(r); });
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
