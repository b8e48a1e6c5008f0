// SPDX-License-Identifier: Apache-2.0
#include "cli/film.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

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

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_name.h"
#include "base/frames.h"
#include "cli/options.h"

namespace orrery::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEncoder = "ffmpeg";

bool is_installed(const std::string& program) {
  const char* const path = std::getenv("PATH");
  const std::string folders = path != nullptr ? path : "";
  for (std::size_t begin = 0; begin <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', begin), folders.size());
    if (access((folders.substr(begin, end - begin) + "/" + program).c_str(), X_OK) == 0) return true;
    begin = end + 1;
  }
  return false;
}

/// The options of ffmpeg between input and output. Videos have sizes of even numbers: the last column or row is left
/// out. Colours are those of sRGB images, which display programs show as such.
std::vector<std::string> encoding_of(const fs::path& file) {
  if (base::extension(file) == ".gif")
    return {"-filter_complex",
            "[0:v]split[a][b];[a]palettegen=stats_mode=diff[p];[b][p]paletteuse",
            "-loop",
            "0",
            "-f",
            "gif"};
  return {"-vf",
          "crop=trunc(iw/2)*2:trunc(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv",
          "-c:v",
          "libx264",
          "-crf",
          "18",
          "-pix_fmt",
          "yuv420p",
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "iec61966-2-1",
          "-color_range",
          "tv",
          "-movflags",
          "+faststart",
          "-f",
          "mp4"};
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// A running ffmpeg that reads images from a pipe.
class Encoder {
 public:
  Encoder(const fs::path& film, const fs::path& output, double fps) : messages_(std::tmpfile()) {
    std::vector<std::string> words = {
        kEncoder, "-nostdin", "-y", "-loglevel", "error", "-f", "image2pipe", "-framerate", fmt::format("{}", fps),
        "-c:v",   "png",      "-i", "pipe:0"};
    for (std::string& word : encoding_of(film)) words.push_back(std::move(word));
    words.push_back("file:" + output.string());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::array<int, 2> ends{};
    if (!messages_ || pipe2(ends.data(), O_CLOEXEC) != 0) fail_to_start(errno);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(messages_.get()), STDERR_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    const int error = posix_spawnp(&process_, kEncoder, &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[0]);
    input_ = ends[1];
    if (error != 0) fail_to_start(error);
  }
  ~Encoder() {
    if (input_ >= 0) close(input_);
    if (process_ > 0) waitpid(process_, nullptr, 0);
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  /// Sends bytes. False if ffmpeg has ended: the program ignores SIGPIPE.
  bool send(const char* bytes, std::size_t size) const {
    while (size > 0) {
      const ssize_t sent = write(input_, bytes, size);
      if (sent < 0 && errno == EINTR) continue;
      if (sent <= 0) return false;
      bytes += sent;
      size -= static_cast<std::size_t>(sent);
    }
    return true;
  }

  /// Waits for the end.
  ///
  /// Result     an error message, or an empty string
  std::string finish() {
    close(std::exchange(input_, -1));
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;
    process_ = 0;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
    const std::string how = WIFSIGNALED(status) ? fmt::format("was ended by signal {}", WTERMSIG(status))
                                                : fmt::format("failed with status {}", WEXITSTATUS(status));
    const std::string said = message();
    return said.empty() ? how : how + ": " + said;
  }

 private:
  [[noreturn]] static void fail_to_start(int error) {
    throw base::Error(base::ErrorKind::kIo, fmt::format("{} cannot be started: {}", kEncoder, std::strerror(error)));
  }

  /// The last line that ffmpeg printed.
  std::string message() const {
    std::rewind(messages_.get());
    std::string last;
    char line[1024];
    while (std::fgets(line, sizeof line, messages_.get()) != nullptr) last = line;
    while (!last.empty() && last.back() == '\n') last.pop_back();
    return last;
  }

  File messages_;
  int input_ = -1;
  pid_t process_ = 0;
};

bool send_file(const Encoder& encoder, const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw base::Error(base::ErrorKind::kIo, fmt::format("cannot read {}", file.string()));
  std::array<char, 1 << 16> block{};
  while (in.read(block.data(), block.size()) || in.gcount() > 0)
    if (!encoder.send(block.data(), static_cast<std::size_t>(in.gcount()))) return false;
  return true;
}

}  // namespace

void FilmSettings::apply(SceneOptions& scene, plot::PlotOptions& plot) const {
  if (fps != FilmSettings().fps) scene.set(fmt::format("animation.fps={}", fps));
  if (turntable_s <= 0) return;
  const int count = std::max(1, static_cast<int>(std::lround(turntable_s * fps)));
  scene.set(fmt::format("animation.turntable={}", count));
  if (plot.all_frames || !plot.frames.empty()) return;
  for (int frame = 1; frame <= count; ++frame) plot.frames.push_back(frame);
  if (!plot.points.frame) plot.points.frame = 1;
}

Film::Film(fs::path file, double fps, bool keeps_frames)
    : file_(std::move(file)), folder_(file_.string() + ".frames"), fps_(fps), keeps_frames_(keeps_frames) {
  if (!is_installed(kEncoder))
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

void Film::encode(const std::vector<int>& frames) const {
  const fs::path unfinished = file_.string() + ".part";
  std::string error;
  {
    Encoder encoder(file_, unfinished, fps_);
    for (const int frame : frames)
      if (!send_file(encoder, base::with_frame(frame_pattern().string(), frame))) break;
    error = encoder.finish();
  }
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
  for (const int frame : frames) fs::remove(base::with_frame(frame_pattern().string(), frame), failed);
}

}  // namespace orrery::cli
