// SPDX-License-Identifier: Apache-2.0
#include "data/data_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "base/error.h"
#include "support/data_tables.h"
#include "support/temp_dir.h"

namespace orrery::data {

namespace {

constexpr const char* kDump =
    "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n"
    "ITEM: ATOMS id type x y z\n1 1 1 2 3\n";
constexpr const char* kWater = "1\nwater\nO 1 2 3\n";
constexpr const char* kPdb = "ATOM      1  CA  ALA A   1       1.000   2.000   3.000  1.00  0.00           C\n";
constexpr const char* kCif = "data_a\nloop_\n_atom_site.cartn_x\n_atom_site.cartn_y\n_atom_site.cartn_z\n1 2 3\n";

class DataOpen : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    support::write_bytes(folder_ / name, text);
    return folder_ / name;
  }
  std::string format_of(const std::string& name, const std::string& text) { return open(write(name, text))->format; }
  std::string errors_of(const std::string& name, const std::string& text) {
    return support::read_faults(write(name, text));
  }

  support::TempDir folder_;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/// Text of ASCII characters in UTF-16.
std::string utf16(const std::string& text, bool is_big_endian) {
  std::string out;
  for (const char c : text) out += is_big_endian ? std::string{'\0', c} : std::string{c, '\0'};
  return out;
}

TEST_F(DataOpen, ColumnsAreReadInTheOrderOfTheRequest) {
  std::set<std::string> formats;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(ORRERY_ROOT "/tests/fuzz/corpus")) {
    if (!entry.is_regular_file()) continue;
    try {
      const auto file = open(entry.path());
      std::vector<std::string> names, found;
      for (const ColumnInfo& column : file->describe(0).columns)
        if (!column.is_derived) names.insert(names.begin(), column.name);
      for (const Column& column : file->read(0, names).columns) found.push_back(column.name);
      EXPECT_EQ(found, names) << entry.path();
      formats.insert(file->format);
    } catch (const base::Error&) {  // not a data file, or damaged
    }
  }
  EXPECT_EQ(formats.size(), 19) << testing::PrintToString(formats);
}

TEST_F(DataOpen, AnAmbiguousFirstWordIsReadAsTheExtensionSays) {
  EXPECT_EQ(format_of("a.csv", "data_x,y,z,x\n1,2,3,4\n"), "CSV");
  EXPECT_EQ(format_of("a.txt", "data_x x y z\n1 2 3 4\n"), "CSV");
  EXPECT_EQ(format_of("a.csv", "MODEL  x y z\nATOM   1 2 3\n"), "CSV");
  EXPECT_EQ(format_of("a.csv", "data_a _b x y z\n1 2 3 4 5\n"), "CSV");
  EXPECT_EQ(format_of("a.txt", kCif), "mmCIF");
  EXPECT_EQ(format_of("a.txt", std::string("# comment\n\n") + kCif), "mmCIF");
  EXPECT_NE(errors_of("a.cif", "data_a\n").find("_atom_site"), std::string::npos);
  // An unambiguous signature counts more than the extension.
  EXPECT_EQ(format_of("a.csv", kDump), "LAMMPS dump");
}

TEST_F(DataOpen, AByteOrderMarkIsSkippedInAllFormats) {
  const std::string mark = "\xEF\xBB\xBF";
  EXPECT_EQ(format_of("a.dump", mark + kDump), "LAMMPS dump");
  EXPECT_EQ(format_of("a.xyz", mark + kWater), "XYZ");
  EXPECT_EQ(format_of("a.pdb", mark + kPdb), "PDB");
  EXPECT_EQ(format_of("a.cif", mark + kCif), "mmCIF");
  EXPECT_EQ(support::numbers(support::read_table(folder_ / "a.dump"), "y"), std::vector<double>{2});
}

TEST_F(DataOpen, OtherEncodingsAreNamedWithARemedy) {
  for (const bool is_big_endian : {false, true})
    for (const auto& [name, text] :
         {std::pair("a.dump", std::string(kDump)), {"a.xyz", kWater}, {"a.pdb", kPdb}, {"a.csv", "x,y,z\n"}}) {
      const std::string mark = is_big_endian ? "\xFE\xFF" : "\xFF\xFE";
      for (const std::string& begin : {std::string(), mark})
        EXPECT_NE(errors_of(name, begin + utf16(text, is_big_endian)).find("iconv -f UTF-16 -t UTF-8"),
                  std::string::npos)
            << name;
    }
  for (const auto& [name, text] : {std::pair("a.dump", std::string(kDump)),
                                   {"a.xyz", kWater},
                                   {"a.pdb", std::string(kPdb) + "END\n"},
                                   {"a.csv", "x,y,z\n1,2,3"}})
    EXPECT_NE(errors_of(name, replaced(text, "\n", "\r")).find("tr '\\r' '\\n'"), std::string::npos) << name;
}

TEST_F(DataOpen, OneLineWithoutItsEndIsNoOtherEncoding) {
  // A read before the first byte is reported by the address sanitizer only.
  for (const char* text : {"x", "pplyhas more than 2 val", "a line that is too long for the buffer of a short string"})
    EXPECT_NE(errors_of("a.txt", text).find("unknown file format"), std::string::npos) << errors_of("a.txt", text);
}

TEST_F(DataOpen, AnXyzFileWithoutItsFirstLinesNamesThem) {
  EXPECT_NE(errors_of("a.xyz", "C 0 0 0\nC 1.5 0 0\n").find("the number of atoms"), std::string::npos);
}

TEST_F(DataOpen, DataFilesAreRecognisedByContentOrName) {
  EXPECT_TRUE(is_data_file("a.dump", kDump));
  EXPECT_TRUE(is_data_file("a", kCif));
  EXPECT_TRUE(is_data_file("a.gz", "\x1f\x8b\x08"));
  EXPECT_TRUE(is_data_file("a.TSV", "anything"));
  EXPECT_FALSE(is_data_file("a.txt", "[image]\nwidth = 3\n[[sphere]]\ncenter = [1, 2, 3]\n"));
  EXPECT_FALSE(is_data_file("a.txt", ""));
}

}  // namespace
}  // namespace orrery::data
