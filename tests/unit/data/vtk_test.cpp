// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <zlib.h>

#include "data/data_file.h"
#include "support/data_tables.h"
#include "support/mentions.h"

namespace orrery::data {

namespace {

using support::number_bytes;
using support::numbers;

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
  }
  return out;
}

/// The header of an array and its data, as one block or compressed in two blocks.
struct Encoded {
  std::string header, data;
};

template <class Length>
Encoded encoded(const std::string& data, bool is_compressed, bool big) {
  const auto length = [big](std::size_t v) { return number_bytes(static_cast<Length>(v), big); };
  if (!is_compressed) return {length(data.size()), data};
  const std::size_t block = data.size() / 2 + 1;
  std::string sizes, blocks;
  for (std::size_t i = 0; i < data.size(); i += block) {
    const std::string part = data.substr(i, block);
    std::string packed(compressBound(part.size()), '\0');
    uLongf size = packed.size();
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(part.data()), part.size());
    blocks += packed.substr(0, size);
    sizes += length(size);
  }
  return {length(2) + length(block) + length(data.size() % block) + sizes, blocks};
}

std::string root(const std::string& attributes, const std::string& content) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" " + attributes + ">\n" + content +
         "</VTKFile>\n";
}

std::string piece(int points, const std::string& positions, const std::string& data = "") {
  return "<Piece NumberOfPoints=\"" + std::to_string(points) + "\"><PointData>" + data + "</PointData><Points>" +
         positions + "</Points></Piece>\n";
}
std::string poly(const std::string& pieces) { return "<PolyData>\n" + pieces + "</PolyData>\n"; }

std::string ascii(const std::string& type, const std::string& name, int components, const std::string& values) {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" + std::to_string(components) +
         "\" format=\"ascii\">\n" + values + "\n</DataArray>";
}

const std::string kPoints = ascii("Float32", "Points", 3, "1 2 3  4 5 .5");

class DataVtk : public testing::Test {
 protected:
  std::unique_ptr<DataFile> open(const std::string& bytes) {
    support::write_bytes(folder_ / "a.vtp", bytes);
    return data::open(folder_ / "a.vtp");
  }
  Table read(const std::string& bytes) { return support::read_table(*open(bytes)); }
  std::string faults(const std::string& bytes, const OpenOptions& options = {}) {
    support::write_bytes(folder_ / "a.vtp", bytes);
    return support::read_faults(folder_ / "a.vtp", options);
  }
  support::TempDir folder_;
};

TEST_F(DataVtk, AsciiArraysKeepTheirTypes) {
  const std::string data = ascii("Float64", "radius", 1, "0.1 nan") + ascii("Int8", "type", 1, "-1 7") +
                           ascii("UInt16", "a", 1, "65535 0") + ascii("Float32", "vel", 2, "1 2 3e2 -inf") +
                           ascii("UInt8", "RGB", 3, "1 2 3 4 5 255") +
                           "<DataArray type=\"String\" Name=\"s\" format=\"ascii\">65 0 66 0</DataArray>";
  const auto file = open(root("", poly(piece(2, kPoints, data))));
  EXPECT_STREQ(file->format, "VTK");
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(support::columns_text(info),
            "x:float32 y:float32 z:float32 radius:float64 type:int32 a:uint16 vel[1]:float32 vel[2]:float32 "
            "RGB[1]:uint8 RGB[2]:uint8 RGB[3]:uint8");
  EXPECT_EQ(info.rows, 2u);
  EXPECT_EQ(info.roles.radius, "radius");
  EXPECT_EQ(info.roles.type, "type");
  EXPECT_EQ(info.roles.rgb[0], "RGB[1]");
  const Table table = support::read_table(*file);
  EXPECT_EQ(numbers(table, "z"), (std::vector<double>{3, 0.5}));
  EXPECT_EQ(numbers(table, "radius")[0], 0.1);
  EXPECT_TRUE(std::isnan(numbers(table, "radius")[1]));
  EXPECT_EQ(numbers(table, "type"), (std::vector<double>{-1, 7}));
  EXPECT_EQ(numbers(table, "vel[2]"), (std::vector<double>{2, -std::numeric_limits<double>::infinity()}));
  EXPECT_EQ(numbers(table, "RGB[3]"), (std::vector<double>{3, 255}));
  EXPECT_EQ(numbers(file->read(0, {"a", "x"}), "a"), (std::vector<double>{65535, 0}));
}

TEST_F(DataVtk, UnstructuredGrids) {
  EXPECT_EQ(numbers(read("<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>" + piece(2, kPoints) +
                         "</UnstructuredGrid></VTKFile>"),
                    "y"),
            (std::vector<double>{2, 5}));
}

TEST_F(DataVtk, EveryEncodingHasTheSameNumbers) {
  for (int variant = 0; variant < 8; ++variant) {
    const bool big = (variant & 1) != 0, is_long = (variant & 2) != 0, is_compressed = (variant & 4) != 0;
    std::string positions, ids;
    for (int i = 0; i < 500; ++i) {
      for (int k = 0; k < 3; ++k) positions += number_bytes(i + 0.25 * k, big);
      ids += number_bytes(static_cast<std::int64_t>(i) << 33, big);
    }
    const auto encode = [&](const std::string& data) {
      return is_long ? encoded<std::uint64_t>(data, is_compressed, big)
                     : encoded<std::uint32_t>(data, is_compressed, big);
    };
    const std::string attributes = std::string("byte_order=\"") + (big ? "BigEndian" : "LittleEndian") +
                                   "\" header_type=\"" + (is_long ? "UInt64" : "UInt32") + "\"" +
                                   (is_compressed ? " compressor=\"vtkZLibDataCompressor\"" : "");
    const auto array = [](const char* type, const char* name, int components, const std::string& rest) {
      return std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
             std::to_string(components) + "\" " + rest + "</DataArray>";
    };
    const Encoded p = encode(positions), id = encode(ids);
    const auto at = [](std::size_t offset) { return "format=\"appended\" offset=\"" + std::to_string(offset) + "\">"; };
    const auto with = [&](const std::string& first, const std::string& second, const std::string& appended) {
      return root(attributes,
                  poly(piece(500, array("Float64", "Points", 3, first), array("Int64", "id", 1, second))) + appended);
    };
    const std::string p64 = base64(p.header) + base64(p.data), id64 = base64(id.header + id.data);
    // Raw data may contain markup.
    const std::string files[] = {
        with("format=\"binary\">\n  " + p64 + "\n  ", "format=\"binary\">" + id64, ""),
        with(at(0), at(p64.size()), "<AppendedData encoding=\"base64\">\n _" + p64 + id64 + "\n</AppendedData>"),
        with(at(12), at(12 + p.header.size() + p.data.size()),
             "<AppendedData encoding=\"raw\">\n _</VTKFile><&" + p.header + p.data + id.header + id.data +
                 "\n</AppendedData>")};
    for (const std::string& bytes : files) {
      const Table table = read(bytes);
      ASSERT_EQ(table.rows, 500u);
      const auto x = numbers(table, "x"), z = numbers(table, "z"), column = numbers(table, "id");
      for (std::size_t i = 0; i < 500; ++i) {
        ASSERT_EQ(x[i], static_cast<double>(i)) << variant;
        ASSERT_EQ(z[i], static_cast<double>(i) + 0.5) << variant;
        ASSERT_EQ(column[i], static_cast<double>(i) * 8589934592.0) << variant;
      }
    }
  }
}

TEST_F(DataVtk, PiecesAreConcatenated) {
  const std::string one = piece(2, kPoints, ascii("Int32", "id", 1, "1 2")), none = piece(0, ""),
                    two = piece(1, ascii("Float32", "Points", 3, "7 8 9"), ascii("Int32", "id", 1, "3"));
  const Table table = read(root("", poly(none + one + none + two)));
  EXPECT_EQ(numbers(table, "x"), (std::vector<double>{1, 4, 7}));
  EXPECT_EQ(numbers(table, "id"), (std::vector<double>{1, 2, 3}));
  EXPECT_TRUE(test::mentions(faults(root("", poly(one + piece(2, kPoints)))), {"pieces", "`id`"}));
  EXPECT_TRUE(test::mentions(faults(root("", poly(one + piece(2, kPoints, ascii("Int64", "id", 1, "1 2"))))),
                             {"`id`", "different"}));
}

TEST_F(DataVtk, ArraysOfBitsAreLeftOut) {
  const std::string bits = ascii("Bit", "flags", 1, "1 0");
  EXPECT_EQ(support::columns_text(open(root("", poly(piece(2, kPoints, bits))))->describe(0)),
            "x:float32 y:float32 z:float32");
  EXPECT_NE(faults(root("", poly(piece(2, ascii("Bit", "Points", 3, "1 0 1 1 0 1"))))), "");
}

TEST_F(DataVtk, NoPoints) {
  const auto file = open(root("", poly(piece(0, ""))));
  EXPECT_EQ(file->describe(0).rows, 0u);
  EXPECT_EQ(support::read_table(*file).columns.size(), 3u);
}

TEST_F(DataVtk, NamesAreUnique) {
  EXPECT_EQ(
      support::columns_text(
          open(root("", poly(piece(2, kPoints, ascii("Float32", "x", 1, "1 2") + ascii("Float32", "a&lt;", 1, "1 2")))))
              ->describe(0)),
      "x:float32 y:float32 z:float32 x_2:float32 a<:float32");
}

TEST_F(DataVtk, OtherFilesOfVtkAreRefusedWithARemedy) {
  EXPECT_TRUE(test::mentions(faults("# vtk DataFile Version 3.0\n"), {"format", "VTK", "ParaView"}));
  EXPECT_TRUE(test::mentions(faults("<VTKFile type=\"PPolyData\"/>"), {"pieces", "ParaView"}));
  EXPECT_EQ(
      faults("<VTKFile type=\"ImageData\"/>"),
      "VTK type `ImageData` is not supported; supported: PolyData and UnstructuredGrid; save the points as a .vtp file "
      "with ParaView\n");
  EXPECT_EQ(
      faults(root("compressor=\"vtkLZ4DataCompressor\"", poly(piece(2, kPoints)))),
      "the compression `vtkLZ4DataCompressor` is not supported; save the file with zlib compression, or without\n");
  EXPECT_TRUE(test::mentions(faults(root("byte_order=\"Middle\"", "")), {"order", "`Middle`"}));
  EXPECT_TRUE(test::mentions(faults(root("header_type=\"Int\"", "")), {"header", "`Int`"}));
}

TEST_F(DataVtk, MalformedXmlHasALine) {
  EXPECT_EQ(faults(root("", "<PolyData>\n<Piece>\n</Poly>")).rfind("5: malformed XML: ", 0), 0u);
  const std::string good = root("", poly(piece(2, kPoints, ascii("Int32", "id", 1, "1 2"))));
  ASSERT_EQ(faults(good), "");
  for (std::size_t size = 40; size + 2 < good.size(); size += 5) EXPECT_NE(faults(good.substr(0, size)), "") << size;
}

TEST_F(DataVtk, WrongNumbersOfValuesAreRefused) {
  EXPECT_TRUE(test::mentions(faults(root("", poly(piece(3, kPoints)))), {"`Points`", "24", "bytes", "3", "12"}));
  EXPECT_TRUE(test::mentions(faults(root("", poly(piece(1, kPoints)))), {"`Points`", "24", "bytes", "1", "12"}));
  EXPECT_TRUE(test::mentions(faults(root("", poly(piece(2, ascii("Float32", "Points", 3, "1 2 3 4 5 six"))))),
                             {"`Points`", "`six`", "number"}));
  EXPECT_TRUE(test::mentions(faults(root("", poly(piece(2, kPoints, ascii("UInt8", "a", 1, "1 256"))))),
                             {"`a`", "`256`", "number"}));
  EXPECT_TRUE(
      test::mentions(faults(root("", poly(piece(2, kPoints, ascii("Half", "a", 1, "1 2"))))), {"`a`", "`Half`"}));
  EXPECT_TRUE(test::mentions(faults(root("", poly("<Piece NumberOfPoints=\"2\"/>"))), {"oints"}));
  EXPECT_TRUE(test::mentions(faults(root("", poly(""))), {"there"}));
  EXPECT_TRUE(
      test::mentions(faults(root("", poly("<Piece NumberOfPoints=\"-2\"/>"))), {"NumberOfPoints", "`-2`", "integer"}));
  EXPECT_TRUE(test::mentions(faults(root("", poly("<Piece NumberOfPoints=\"1000000000000\">" + kPoints + "</Piece>"))),
                             {"declares", "1000000000000"}));
  EXPECT_EQ(faults(root("", poly(piece(2, ascii("Float32", "Points", 2, "1 2 3 4")))))
                .rfind("there are no columns x, y and z", 0),
            0u);
  EXPECT_TRUE(test::mentions(faults(root("", poly(piece(2, kPoints, ascii("Int8", "a", 1000000000, ""))))),
                             {"4096", "columns"}));
}

TEST_F(DataVtk, TooManyArraysAreRefused) {
  std::string arrays;
  for (int i = 0; i < 4096; ++i) arrays += ascii("Int8", "a" + std::to_string(i), 0, "");
  EXPECT_EQ(faults(root("", poly(piece(2, kPoints, arrays)))), "") << "without components";
  arrays.clear();
  for (int i = 0; i < 4096; ++i) arrays += ascii("Int8", "a" + std::to_string(i), 1, "1 2");
  EXPECT_TRUE(test::mentions(faults(root("", poly(piece(2, kPoints, arrays)))), {"4096", "arrays"}));
}

TEST_F(DataVtk, BinaryHeadersBeyondTheDataAreRefusedBeforeAllocation) {
  const auto with = [](const std::string& attributes, const std::string& bytes) {
    return root(attributes, poly(piece(2, "<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"binary\">" +
                                              base64(bytes) + "</DataArray>")));
  };
  const auto appended = [](const std::string& attributes, const std::string& offset, const std::string& bytes) {
    return root(attributes, poly(piece(2,
                                       "<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"appended\" "
                                       "offset=\"" +
                                           offset + "\"/>")) +
                                "<AppendedData encoding=\"raw\">_" + bytes + "</AppendedData>");
  };
  const std::string data(24, '\0'), longs = "header_type=\"UInt64\"", zlib = "compressor=\"vtkZLibDataCompressor\"";
  const std::string huge = number_bytes(std::uint64_t{1} << 62);
  ASSERT_EQ(faults(with("", number_bytes(24) + data)), "");
  ASSERT_EQ(faults(appended("", "0", number_bytes(24) + data)), "");
  EXPECT_TRUE(test::mentions(faults(with("", number_bytes(25) + data)), {"`Points`", "end"}));
  EXPECT_TRUE(test::mentions(faults(with(longs, huge + data)), {"`Points`", "end"}));
  EXPECT_TRUE(test::mentions(faults(with("", "ab")), {"`Points`", "end"}));
  EXPECT_TRUE(test::mentions(faults(appended(longs, "0", huge + data)), {"`Points`", "end"}));
  EXPECT_TRUE(test::mentions(faults(appended("", "200", number_bytes(24) + data)), {"`Points`", "end"}));
  EXPECT_TRUE(
      test::mentions(faults(appended("", "18446744073709551615", number_bytes(24) + data)), {"`Points`", "offset"}));
  EXPECT_TRUE(test::mentions(faults(appended("", "", number_bytes(24) + data)), {"negative", "integer"}));

  const Encoded good = encoded<std::uint32_t>(data, true, false);
  ASSERT_EQ(faults(with(zlib, good.header + good.data)), "");
  std::string damaged = good.data;
  damaged[6] = static_cast<char>(damaged[6] ^ 0x55);
  EXPECT_TRUE(test::mentions(faults(with(zlib, good.header + damaged)), {"`Points`", "damaged"}));
  const Encoded shorter = encoded<std::uint32_t>(data.substr(0, 22), true, false);
  std::string claims_more = shorter.header;
  claims_more.replace(4, 8, number_bytes(12) + number_bytes(12));  // blocks of 12 bytes, not of 12 and 10
  EXPECT_TRUE(test::mentions(faults(with(zlib, claims_more + shorter.data)), {"`Points`", "damaged"}));
  EXPECT_TRUE(test::mentions(faults(with(zlib, good.header + good.data.substr(0, 20))), {"`Points`", "end"}));
  const auto header = [](std::uint64_t blocks, std::uint64_t size, std::uint64_t last, std::uint64_t packed) {
    return number_bytes(blocks) + number_bytes(size) + number_bytes(last) + number_bytes(packed);
  };
  for (const std::string& wrong :
       {header(std::uint64_t{1} << 60, 24, 0, 24), header(1, std::uint64_t{1} << 60, 0, 24), header(1, 24, 0, ~0ull)})
    EXPECT_NE(faults(with(longs + " " + zlib, wrong + data)), "");
  EXPECT_TRUE(test::mentions(faults(with(longs + " " + zlib, header(1, 24, 25, 24) + data)), {"`Points`", "header"}));
}

TEST_F(DataVtk, DecompressedDataAreLimited) {
  const Encoded zeros = encoded<std::uint32_t>(std::string(1200000, '\0'), true, false);
  const std::string bytes =
      root("compressor=\"vtkZLibDataCompressor\"",
           poly(piece(100000, "<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"binary\">" +
                                  base64(zeros.header) + base64(zeros.data) + "</DataArray>")));
  OpenOptions options;
  options.decompressed_limit = 1200000;
  EXPECT_EQ(faults(bytes, options), "");
  options.decompressed_limit = 1199999;
  EXPECT_TRUE(test::mentions(faults(bytes, options), {"`Points`", "1.1", "MiB"}));
}

TEST_F(DataVtk, MalformedBase64IsRefused) {
  const std::string good = base64(number_bytes(24) + std::string(24, '\0'));
  for (const std::string& wrong : {std::string("GAAA"), "GA!A" + good, "G===" + good, "====" + good, "GA=A" + good})
    EXPECT_NE(faults(root("", poly(piece(2, std::string("<DataArray type=\"Float32\" NumberOfComponents=\"3\" "
                                                        "format=\"binary\">") +
                                                wrong + "</DataArray>")))),
              "")
        << wrong;
}

}  // namespace
}  // namespace orrery::data
