// SPDX-License-Identifier: Apache-2.0
#include "cli/film.h"

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_name.h"
#include "base/frames.h"
#include "base/text.h"
#include "cli/options.h"

namespace orrery::cli {
namespace {

namespace fs = std::filesystem;

/// Options of ffmpeg between input and output. Videos have sizes of even numbers: the last column or row is left out.
/// Colours are those of sRGB images, which display programs show as such.
constexpr const char* kGif =
    "-filter_complex '[0:v]split[a][b];[a]palettegen=stats_mode=diff[p];[b][p]paletteuse' -loop 0 -f gif";
constexpr const char* kVideo =
    "-vf 'crop=trunc(iw/2)*2:trunc(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv' -c:v libx264 -crf 18 "
    "-pix_fmt yuv420p -colorspace bt709 -color_primaries bt709 -color_trc iec61966-2-1 -color_range tv "
    "-movflags +faststart -f mp4";

/// A GIF counts in hundredths of a second, and players show one of them as ten.
constexpr int kMostGifRate = 50;

/// Sends a file. False if the reader of the pipe has ended: the program ignores SIGPIPE.
bool send_file(const fs::path& file, std::FILE* pipe) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw base::Error(base::ErrorKind::kIo, fmt::format("cannot read {}", file.string()));
  std::array<char, 1 << 16> block{};
  while (in.read(block.data(), block.size()) || in.gcount() > 0)
    if (const auto size = static_cast<std::size_t>(in.gcount()); std::fwrite(block.data(), 1, size, pipe) != size)
      return false;
  return true;
}

std::string last_line(const fs::path& file) {
  std::ifstream in(file);
  std::string last;
  for (std::string line; std::getline(in, line);) last = line;
  return last;
}

/// Encodes images to `output`, with the options for the name of `film`.
///
/// Result     how ffmpeg failed, or an empty string
std::string encoded(const std::vector<fs::path>& images, const fs::path& film, const fs::path& output, double fps) {
  const base::TempDir folder;
  const fs::path messages = folder.path() / "messages";
  const std::string command = fmt::format(
      "exec ffmpeg -nostdin -y -loglevel error -f image2pipe -framerate {} -c:v png -i pipe:0 {} {} > /dev/null 2> {}",
      fps, base::extension(film) == ".gif" ? kGif : kVideo, base::quoted("file:" + output.string()),
      base::quoted(messages.string()));
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "we"), pclose);
  if (!pipe) return fmt::format("cannot be started: {}", std::strerror(errno));
  for (const fs::path& image : images)
    if (!send_file(image, pipe.get())) break;
  const int status = pclose(pipe.release());
  const std::string said = last_line(messages);
  // If it cannot write the end of a film, some versions print an error, but succeed.
  if (status == 0) return said.empty() ? "" : "reported an error: " + said;
  const std::string how = WIFSIGNALED(status) ? fmt::format("was ended by signal {}", WTERMSIG(status))
                                              : fmt::format("failed with status {}", WEXITSTATUS(status));
  return said.empty() ? how : how + ": " + said;
}

}  // namespace

void FilmSettings::apply(SceneOptions& scene, plot::PlotOptions& plot) const {
  const load::Overrides overrides = scene.overrides();
  if (fps != FilmSettings().fps) {
    refuse_second("--fps", overrides, "animation.fps");
    scene.set(fmt::format("animation.fps={}", fps));
  }
  if (turntable_s <= 0) return;
  refuse_second("--turntable", overrides, "animation.turntable");
  const int count = std::max(1, static_cast<int>(std::lround(turntable_s * fps)));
  scene.set(fmt::format("animation.turntable={}", count));
  if (plot.all_frames || !plot.frames.empty()) return;
  for (int frame = 1; frame <= count; ++frame) plot.frames.push_back(frame);
  if (!plot.points.frame) plot.points.frame = 1;
}

Film::Film(fs::path file, double fps, bool keeps_frames)
    : file_(std::move(file)), folder_(file_.string() + ".frames"), fps_(fps), keeps_frames_(keeps_frames) {
  if (fps > kMostGifRate && base::extension(file_) == ".gif")
    base::refuse(fmt::format("{}: a GIF has at most {} frames per second; write an MP4", file_.string(), kMostGifRate));
  if (std::system("command -v ffmpeg > /dev/null 2>&1") != 0)
    throw base::Error(base::ErrorKind::kCannotCreate,
                      fmt::format("{} cannot be created: the program ffmpeg was not found; install the package ffmpeg, "
                                  "or write an image for each frame, e.g. -o out.####.png",
                                  file_.string()));
  base::check_creatable(file_);
  std::error_code error;
  fs::create_directory(folder_, error);
  if (error)
    throw base::Error(base::ErrorKind::kCannotCreate,
                      fmt::format("cannot create the folder {}: {}", folder_.string(), error.message()));
}

Film::~Film() {
  std::error_code not_empty;
  fs::remove(folder_, not_empty);
}

bool Film::is_film(const fs::path& file) {
  const std::string extension = base::extension(file);
  return extension == ".mp4" || extension == ".gif";
}

fs::path Film::frame_pattern() const { return folder_ / "frame.######.png"; }

void Film::check_size(int width, int height) const {
  if (base::extension(file_) != ".gif" && std::min(width, height) < 2)
    base::refuse(fmt::format("{}: a video is at least 2 pixels wide and high", file_.string()));
}

void Film::encode(const std::vector<int>& frames) const {
  std::vector<fs::path> images;
  for (const int frame : frames) images.emplace_back(base::with_frame(frame_pattern().string(), frame));
  const fs::path unfinished = file_.string() + ".part";
  std::string error = encoded(images, file_, unfinished, fps_);
  std::error_code failed;
  if (error.empty()) fs::rename(unfinished, file_, failed);
  if (failed) error = failed.message();
  if (!error.empty()) {
    fs::remove(unfinished, failed);
    throw base::Error(base::ErrorKind::kIo,
                      fmt::format("{}: ffmpeg {}; the frames are in {}, and the same command continues from them",
                                  file_.string(), error, folder_.string()));
  }
  if (keeps_frames_) return;
  for (const fs::path& image : images) fs::remove(image, failed);
}

}  // namespace orrery::cli
