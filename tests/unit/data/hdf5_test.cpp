// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <numeric>

#include "base/error.h"
#include "data/data_file.h"
#include "support/data_tables.h"
#include "support/temp_dir.h"

namespace orrery::data {

namespace {

using support::values;
using Strings = std::vector<std::string>;

/// Writes snapshots with the HDF5 library.
class Snapshot {
 public:
  explicit Snapshot(const std::filesystem::path& file)
      : file_(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)),
        header_(H5Gcreate2(file_, "Header", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)) {}
  ~Snapshot() {
    H5Gclose(header_);
    H5Fclose(file_);
  }
  Snapshot(const Snapshot&) = delete;
  Snapshot& operator=(const Snapshot&) = delete;

  void attribute(const char* name, hid_t type, const std::vector<double>& values) {
    const hsize_t count = values.size();
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    const hid_t id = H5Acreate2(header_, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(id, H5T_NATIVE_DOUBLE, values.data());
    H5Aclose(id);
    H5Sclose(space);
  }
  void group(const char* name) { H5Gclose(H5Gcreate2(file_, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)); }

  /// `stored`   type in the file; `chunk` rows, 0: contiguous; chunks are shuffled, compressed and have checksums
  template <typename T>
  void dataset(const std::string& name, hid_t stored, hid_t memory, const std::vector<hsize_t>& extent,
               const std::vector<T>& values, hsize_t chunk = 0) {
    const hid_t space = H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr);
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    if (chunk > 0) {
      std::vector<hsize_t> chunks = extent;
      chunks[0] = chunk;
      H5Pset_chunk(creation, static_cast<int>(chunks.size()), chunks.data());
      H5Pset_shuffle(creation);
      H5Pset_deflate(creation, 6);
      H5Pset_fletcher32(creation);
    }
    const hid_t id = H5Dcreate2(file_, name.c_str(), stored, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    if (!values.empty()) H5Dwrite(id, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(id);
    H5Pclose(creation);
    H5Sclose(space);
  }
  void positions(int type, const std::vector<double>& xyz) {
    group(("PartType" + std::to_string(type)).c_str());
    dataset("PartType" + std::to_string(type) + "/Coordinates", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {xyz.size() / 3, 3},
            xyz);
  }

 private:
  hid_t file_, header_;
};

class DataHdf5 : public testing::Test {
 protected:
  std::unique_ptr<DataFile> opened(std::optional<int> component = {}, const char* name = "a.hdf5") {
    OpenOptions options;
    options.component = component;
    return data::open(folder_ / name, options);
  }
  base::Diagnostic error_of(const std::function<void()>& action) {
    try {
      action();
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kBadData);
      return error.diagnostics().at(0);
    }
    return {};
  }

  support::TempDir folder_;
};

TEST_F(DataHdf5, ColumnsKeepTheirStoredTypes) {
  {
    Snapshot s(folder_ / "a.hdf5");
    s.attribute("BoxSize", H5T_IEEE_F64LE, {100});
    s.attribute("NumPart_Total", H5T_STD_U32LE, {0, 0, 0, 0, 2, 0});
    s.attribute("NumPart_Total_HighWord", H5T_STD_U32LE, {0, 0, 0, 0, 0, 0});
    s.attribute("NumFilesPerSnapshot", H5T_STD_I32LE, {1});
    s.group("PartType4");
    s.dataset<float>("PartType4/Coordinates", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {2, 3}, {1, 2, 3, 4, 5, 6});
    s.dataset<double>("PartType4/Masses", H5T_IEEE_F64BE, H5T_NATIVE_DOUBLE, {2}, {0.5, 0.25});
    s.dataset<std::uint64_t>("PartType4/ParticleIDs", H5T_STD_U64LE, H5T_NATIVE_UINT64, {2}, {7, 1ULL << 40});
    s.dataset<int>("PartType4/Flags", H5T_STD_I8LE, H5T_NATIVE_INT, {2}, {-1, 1});
    s.dataset<int>("PartType4/Level", H5T_STD_U8LE, H5T_NATIVE_INT, {2}, {200, 1});
    s.dataset<int>("PartType4/Word", H5T_STD_U16LE, H5T_NATIVE_INT, {2}, {60000, 1});
    s.dataset<std::uint32_t>("PartType4/Count", H5T_STD_U32LE, H5T_NATIVE_UINT32, {2}, {4000000000U, 1});
    s.dataset<float>("PartType4/Velocities", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {2, 3}, {6, 5, 4, 3, 2, 1});
    s.dataset<float>("PartType4/Single", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {2, 1}, {8, 9});
    s.dataset<float>("PartType4/OtherRows", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {3}, {1, 2, 3});
    s.dataset<float>("PartType4/Cube", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {2, 1, 1}, {1, 2});
  }
  const auto file = opened();
  EXPECT_STREQ(file->format, "HDF5");
  EXPECT_EQ(file->frame_count(), 1);
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(info.rows, 2U);
  EXPECT_EQ(info.roles.position, (std::array<std::string, 3>{"x", "y", "z"}));
  EXPECT_EQ(info.roles.id, "ParticleIDs");
  ASSERT_TRUE(info.box);
  EXPECT_EQ(info.box->edges[2], (Vec3d{0, 0, 100}));
  const std::vector<std::string> names = support::column_names(info);
  EXPECT_EQ(names, (Strings{"x", "y", "z", "Count", "Flags", "Level", "Masses", "ParticleIDs", "Single",
                            "Velocities[1]", "Velocities[2]", "Velocities[3]", "Word"}));
  const Table table = file->read(0, names);
  ASSERT_EQ(table.columns.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(table.columns[i].type(), info.columns[i].type) << names[i];
  EXPECT_EQ(values<float>(table, "y"), (std::vector<float>{2, 5}));
  EXPECT_EQ(values<double>(table, "Masses"), (std::vector<double>{0.5, 0.25}));
  EXPECT_EQ(values<std::int64_t>(table, "ParticleIDs"), (std::vector<std::int64_t>{7, 1LL << 40}));
  EXPECT_EQ(values<std::int32_t>(table, "Flags"), (std::vector<std::int32_t>{-1, 1}));
  EXPECT_EQ(values<std::uint8_t>(table, "Level"), (std::vector<std::uint8_t>{200, 1}));
  EXPECT_EQ(values<std::uint16_t>(table, "Word"), (std::vector<std::uint16_t>{60000, 1}));
  EXPECT_EQ(values<std::int64_t>(table, "Count"), (std::vector<std::int64_t>{4000000000LL, 1}));
  EXPECT_EQ(values<float>(table, "Velocities[3]"), (std::vector<float>{4, 1}));
  EXPECT_EQ(values<float>(table, "Single"), (std::vector<float>{8, 9}));
}

TEST_F(DataHdf5, ColumnsHaveDistinctNames) {
  {
    Snapshot s(folder_ / "a.hdf5");
    s.group("PartType0");
    s.dataset<float>("PartType0/Coordinates", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {2, 3}, {1, 2, 3, 4, 5, 6});
    s.dataset<float>("PartType0/x", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {2}, {8, 9});
  }
  const Table table = opened()->read(0, {"x_2", "x"});
  EXPECT_EQ(values<float>(table, "x"), (std::vector<float>{1, 4})) << "the position";
  EXPECT_EQ(values<float>(table, "x_2"), (std::vector<float>{8, 9}));
}

TEST_F(DataHdf5, UnsignedIntegersBeyondInt64AreErrors) {
  {
    Snapshot s(folder_ / "a.hdf5");
    s.group("PartType0");
    s.dataset<float>("PartType0/Coordinates", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {2, 3}, {1, 2, 3, 4, 5, 6});
    for (const char* const name : {"PartType0/ParticleIDs", "PartType0/Other"})
      s.dataset<std::uint64_t>(name, H5T_STD_U64LE, H5T_NATIVE_UINT64, {2}, {7, 0x8000000000000007ULL});
  }
  const auto file = opened();
  EXPECT_EQ(values<std::int64_t>(file->read(0, {"ParticleIDs"}), "ParticleIDs").at(0), 7)
      << "ids only identify and order";
  const std::string error = error_of([&] { file->read(0, {"Other"}); }).text;
  EXPECT_NE(error.find("9223372036854775815, larger than the largest int64"), std::string::npos) << error;
}

TEST_F(DataHdf5, CompressedChunksAreRead) {
  // Several blocks of 8 MiB, which are not a multiple of the chunk.
  constexpr std::size_t kRows = 500'000;
  std::vector<double> xyz(kRows * 3);
  std::iota(xyz.begin(), xyz.end(), 0.0);
  {
    Snapshot s(folder_ / "a.hdf5");
    s.group("PartType0");
    s.dataset("PartType0/Coordinates", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {kRows, 3}, xyz, 70'000);
  }
  const Table table = opened()->read(0, {"z", "x"});
  ASSERT_EQ(values<double>(table, "x").size(), kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    ASSERT_EQ(values<double>(table, "x")[i], xyz[3 * i]);
    ASSERT_EQ(values<double>(table, "z")[i], xyz[3 * i + 2]);
  }
}

TEST_F(DataHdf5, ComponentIsSelected) {
  {
    Snapshot s(folder_ / "a.hdf5");
    s.positions(0, {1, 2, 3});
    s.positions(1, {4, 5, 6, 7, 8, 9});
    s.positions(5, {});
  }
  EXPECT_EQ(values<double>(opened(0)->read(0, {"x"}), "x"), (std::vector<double>{1}));
  EXPECT_EQ(values<double>(opened(1)->read(0, {"x"}), "x"), (std::vector<double>{4, 7}));
  EXPECT_EQ(opened(5)->read(0, {"x"}).rows, 0U);
  const auto ambiguous = error_of([this] { opened(); });
  EXPECT_NE(ambiguous.remedy.find("0 (1 particles), 1 (2 particles), 5 (0 particles)"), std::string::npos)
      << ambiguous.remedy;
  const auto absent = error_of([this] { opened(3); });
  EXPECT_NE(absent.text.find("no component 3"), std::string::npos);
  EXPECT_NE(absent.remedy.find("1 (2 particles)"), std::string::npos);
}

TEST_F(DataHdf5, TheOnlyComponentWithParticlesIsTheDefault) {
  {
    Snapshot s(folder_ / "a.hdf5");
    s.positions(0, {});
    s.positions(4, {1, 2, 3});
  }
  EXPECT_EQ(opened()->describe(0).rows, 1U);
}

TEST_F(DataHdf5, FilesOfASnapshotAreJoined) {
  for (int i = 0; i < 3; ++i) {
    Snapshot s(folder_ / ("snap_063." + std::to_string(i) + ".hdf5"));
    s.attribute("NumFilesPerSnapshot", H5T_STD_I32LE, {3});
    s.attribute("NumPart_Total", H5T_STD_U32LE, {3, 0});
    if (i == 1) continue;  // no particles of the type
    s.positions(0, i == 0 ? std::vector<double>{1, 2, 3} : std::vector<double>{4, 5, 6, 7, 8, 9});
  }
  for (const char* name : {"snap_063.0.hdf5", "snap_063.2.hdf5"}) {
    const Table table = opened({}, name)->read(0, {"x", "y"});
    EXPECT_EQ(table.rows, 3U);
    EXPECT_EQ(values<double>(table, "y"), (std::vector<double>{2, 5, 8}));
  }
  std::filesystem::rename(folder_ / "snap_063.0.hdf5", folder_ / "first.hdf5");
  EXPECT_NE(error_of([this] { opened({}, "first.hdf5"); }).text.find("no number"), std::string::npos);
  const auto missing = error_of([this] { opened({}, "snap_063.2.hdf5"); });
  EXPECT_NE(missing.text.find("snap_063.0.hdf5 does not exist"), std::string::npos);
}

TEST_F(DataHdf5, FilesOfASnapshotMustHaveTheSameColumns) {
  for (int i = 0; i < 2; ++i) {
    Snapshot s(folder_ / ("a." + std::to_string(i) + ".hdf5"));
    s.attribute("NumFilesPerSnapshot", H5T_STD_I32LE, {2});
    s.positions(0, {1, 2, 3});
    if (i == 0) s.dataset<float>("PartType0/Masses", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {1}, {1});
  }
  const auto file = opened({}, "a.0.hdf5");
  EXPECT_EQ(file->read(0, {"x"}).rows, 2U);
  const auto error = error_of([&] { file->read(0, {"Masses"}); });
  EXPECT_NE(error.text.find("PartType0/Masses is missing"), std::string::npos);
  EXPECT_NE(error.file.find("a.1.hdf5"), std::string::npos);
}

TEST_F(DataHdf5, TheHeadersCountIncludesItsHighWord) {
  {
    Snapshot s(folder_ / "a.hdf5");
    s.attribute("NumPart_Total", H5T_STD_U32LE, {1});
    s.attribute("NumPart_Total_HighWord", H5T_STD_U32LE, {2});
    s.positions(0, {1, 2, 3});
  }
  const auto error = error_of([this] { opened(); });
  EXPECT_NE(error.text.find("declares 8589934593 particles of PartType0, but there are 1"), std::string::npos)
      << error.text;
}

TEST_F(DataHdf5, OtherFilesAreRefusedWithARemedy) {
  { Snapshot s(folder_ / "a.hdf5"); }
  const auto plain = error_of([this] { opened(); });
  EXPECT_NE(plain.text.find("no group /PartTypeN"), std::string::npos);
  EXPECT_NE(plain.remedy.find("NPY"), std::string::npos);
  {
    Snapshot s(folder_ / "a.hdf5");
    s.group("PartType0");
    s.dataset<float>("PartType0/Coordinates", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {2, 2}, {1, 2, 3, 4});
  }
  EXPECT_NE(error_of([this] { opened(); }).text.find("2 components instead of 3"), std::string::npos);
}

TEST_F(DataHdf5, CompressedFilesAreRefusedWithARemedy) {
  { Snapshot s(folder_ / "a.hdf5"); }
  const std::string gzip = "gzip " + (folder_ / "a.hdf5").string();
  ASSERT_EQ(std::system(gzip.c_str()), 0);
  EXPECT_NE(error_of([this] { opened({}, "a.hdf5.gz"); }).remedy.find("gunzip"), std::string::npos);
}

TEST_F(DataHdf5, DeclaredRowsWithoutDataAreRefused) {
  {
    Snapshot s(folder_ / "a.hdf5");
    s.group("PartType0");
    s.dataset<float>("PartType0/Coordinates", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {1ULL << 50, 3}, {}, 1000);
  }
  const auto file = opened();
  EXPECT_NE(error_of([&] { file->read(0, {"x"}); }).text.find("has no data"), std::string::npos);
}

TEST_F(DataHdf5, TheLimitOfDecompressionIsChecked) {
  {
    Snapshot s(folder_ / "a.hdf5");
    s.group("PartType0");
    s.dataset("PartType0/Coordinates", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {10'000, 3}, std::vector<double>(30'000),
              1000);
  }
  OpenOptions options;
  options.decompressed_limit = 240'000;
  EXPECT_EQ(data::open(folder_ / "a.hdf5", options)->read(0, {"x"}).rows, 10'000U);
  options.decompressed_limit = 239'999;
  const auto file = data::open(folder_ / "a.hdf5", options);
  EXPECT_NE(error_of([&] { file->read(0, {"x"}); }).text.find("decompresses to more than"), std::string::npos);
}

TEST_F(DataHdf5, DamagedDataAreDetectedByTheirChecksums) {
  constexpr std::size_t kRows = 1000;
  std::vector<float> noise(kRows * 3);
  for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = static_cast<float>(i * 7919 % 1009);
  {
    Snapshot s(folder_ / "a.hdf5");
    s.group("PartType0");
    s.dataset("PartType0/Coordinates", H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, {kRows, 3}, noise, kRows);
  }
  std::string bytes = support::file_bytes(folder_ / "a.hdf5");
  bytes[bytes.size() - 1000] = static_cast<char>(bytes[bytes.size() - 1000] ^ 1);  // the chunk is at the end
  support::write_bytes(folder_ / "a.hdf5", bytes);
  const auto file = opened();
  const auto error = error_of([&] { file->read(0, {"x"}); });
  EXPECT_NE(error.text.find("cannot read `Coordinates`: "), std::string::npos) << error.text;
}

TEST_F(DataHdf5, TruncatedFilesAreRefused) {
  {
    Snapshot s(folder_ / "a.hdf5");
    s.positions(0, std::vector<double>(30'000, 1.5));
  }
  const std::string bytes = support::file_bytes(folder_ / "a.hdf5");
  for (const std::size_t size : {bytes.size() - 1, bytes.size() / 2, std::size_t{100}, std::size_t{9}}) {
    support::write_bytes(folder_ / "a.hdf5", bytes.substr(0, size));
    testing::internal::CaptureStderr();
    EXPECT_NE(error_of([this] { opened()->read(0, {"x"}); }).text.find("damaged HDF5 file: "), std::string::npos)
        << size;
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "the library prints its errors";
  }
}

}  // namespace
}  // namespace orrery::data
