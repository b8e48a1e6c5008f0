// SPDX-License-Identifier: Apache-2.0

// Times reading a data file on one and two threads, in alternation, against a search for the newlines in its bytes.
//
//   bench_read_data FILE [COLUMN...]      all frames; default: all columns of the first frame
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "base/error.h"
#include "data/byte_source.h"
#include "data/data_file.h"

namespace {

using namespace orrery;

constexpr int kRuns = 9;

template <typename F>
double seconds(const F& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Reads the file in blocks, and looks for each newline.
std::uint64_t newlines(const std::string& file) {
  const auto bytes = data::ByteSource::open(file, std::uint64_t{16} << 30);
  std::vector<char> block(std::size_t{1} << 20);
  std::uint64_t count = 0;
  for (std::uint64_t at = 0; at < bytes->size(); at += block.size()) {
    const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), bytes->size() - at));
    bytes->read(at, size, block.data());
    const char* p = block.data();
    const char* const end = p + size;
    while ((p = static_cast<const char*>(std::memchr(p, '\n', static_cast<std::size_t>(end - p)))) != nullptr) {
      ++count;
      if (++p == end) break;
    }
  }
  return count;
}

void measure(const std::string& file, std::vector<std::string> columns) {
  const auto bytes = data::ByteSource::open(file, std::uint64_t{16} << 30)->size();
  std::uint64_t rows = 0;
  if (columns.empty())
    for (const auto& column : data::open(file)->describe(0).columns) columns.push_back(column.name);
  const auto read = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return seconds([&] {
      const auto opened = data::open(file);
      rows = 0;
      for (int frame = 0; frame < opened->frame_count(); ++frame) rows += opened->read(frame, columns).rows;
    });
  };
  std::vector<double> one;
  std::vector<double> two;
  std::vector<double> ratio;
  std::vector<double> scan;
  std::uint64_t lines = 0;
  for (int run = 0; run < kRuns; ++run) {
    one.push_back(read(1));
    two.push_back(read(2));
    ratio.push_back(one.back() / two.back());
    scan.push_back(seconds([&] { lines += newlines(file); }));
  }
  const auto print = [&](const char* what, const std::vector<double>& times) {
    const double shortest = *std::min_element(times.begin(), times.end());
    std::printf("%-10s median %.3f s, shortest %.3f s: %.2f million rows/s, %.0f MB/s\n", what, median(times), shortest,
                static_cast<double>(rows) * 1e-6 / shortest, static_cast<double>(bytes) * 1e-6 / shortest);
  };
  std::printf("%s: %llu rows, %zu columns, %llu bytes, %llu lines\n", file.c_str(),
              static_cast<unsigned long long>(rows), columns.size(), static_cast<unsigned long long>(bytes),
              static_cast<unsigned long long>(lines / kRuns));
  print("1 thread", one);
  print("2 threads", two);
  print("newlines", scan);
  std::sort(ratio.begin(), ratio.end());
  std::printf("1 thread / 2 threads: median %.2f, largest %.2f of %d\n", median(ratio), ratio.back(), kRuns);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_read_data FILE [COLUMN...]\n");
    return 2;
  }
  try {
    measure(argv[1], {argv + 2, argv + argc});
  } catch (const base::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    for (const auto& d : error.diagnostics()) std::fputs(base::formatted(d).c_str(), stderr);
    return base::exit_status(error.kind());
  }
}
