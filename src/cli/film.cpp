// SPDX-License-Identifier: Apache-2.0
#include "cli/film.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/file_name.h"
#include "base/frames.h"
#include "base/stop_point.h"
#include "cli/options.h"

namespace orrery::cli {
namespace {

namespace fs = std::filesystem;

/// Options of ffmpeg between input and output. Videos have sizes of even numbers: the last column or row is left out.
/// Colours are those of sRGB images, which display programs show as such.
constexpr const char* kGif =
    "-filter_complex [0:v]split[a][b];[a]palettegen=stats_mode=diff[p];[b][p]paletteuse -loop 0 -f gif";
constexpr const char* kVideo =
    "-vf crop=trunc(iw/2)*2:trunc(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv -c:v libx264 -crf 18 "
    "-pix_fmt yuv420p -colorspace bt709 -color_primaries bt709 -color_trc iec61966-2-1 -color_range tv "
    "-movflags +faststart -f mp4";

/// A GIF counts in hundredths of a second, and players show one of them as ten.
constexpr int kMostGifRate = 50;

/// Whether a program is in one of the folders of PATH. Not by system(), which ignores INT meanwhile.
bool has_program(const std::string& name) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (::access((fs::path(folder) / name).c_str(), X_OK) == 0) return true;
  return false;
}

/// The program ffmpeg, which encodes the images that it is sent. It ends with this object, or if this process is
/// killed.
class Encoder {
 public:
  /// Errors     base::Error(kIo) if no process can be started
  explicit Encoder(std::vector<std::string> words) : messages_(::memfd_create("ffmpeg", MFD_CLOEXEC)) {
    // A socket rather than a pipe: its other end can tell whether everything was read.
    std::array<int, 2> ends{-1, -1};
    if (messages_ >= 0 && ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) == 0)
      child_ = start_program("ffmpeg", std::move(words), {ends[1], -1, messages_}, SIGKILL);
    const int error = errno;
    input_ = ends[0];
    if (ends[1] >= 0) ::close(ends[1]);
    if (child_ > 0) return;
    close();
    throw base::Error(base::ErrorKind::kIo, fmt::format("cannot start ffmpeg: {}", std::strerror(error)));
  }
  ~Encoder() {
    if (child_ > 0) {
      ::kill(child_, SIGKILL);
      ::waitpid(child_, nullptr, 0);
    }
    close();
  }
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;

  /// Sends a file.
  ///
  /// Result     false if ffmpeg reads no more
  /// Errors     base::Error: kIo if the file cannot be read, kStopped
  bool send(const fs::path& file) const {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw base::Error(base::ErrorKind::kIo, fmt::format("cannot read {}", file.string()));
    std::array<char, 1 << 16> block{};
    while (in.read(block.data(), block.size()) || in.gcount() > 0)
      for (const char *at = block.data(), *const end = at + in.gcount(); at != end;) {
        wait_for(POLLOUT);
        const ssize_t sent = ::send(input_, at, static_cast<std::size_t>(end - at), MSG_DONTWAIT | MSG_NOSIGNAL);
        if (sent >= 0) {
          at += sent;
        } else if (!is_to_repeat()) {
          return false;
        }
      }
    return true;
  }

  /// Waits until ffmpeg has ended.
  ///
  /// Result     how it failed, or an empty string
  /// Errors     base::Error(kStopped)
  std::string finish() {
    ::shutdown(input_, SHUT_WR);
    ssize_t received = 0;
    char ignored = 0;
    do {
      wait_for(POLLIN);
      received = ::recv(input_, &ignored, 1, MSG_DONTWAIT);
    } while (received > 0 || (received < 0 && is_to_repeat()));
    const bool has_read_all = received == 0;  // else ECONNRESET
    int status = 0;
    while (::waitpid(child_, &status, WNOHANG) == 0) {
      stop_.check();
      ::poll(nullptr, 0, kWait_ms);
    }
    child_ = -1;
    stop_.check();  // a signal from a terminal ends ffmpeg, too
    const std::string said = last_message();
    const std::string how = WIFSIGNALED(status) ? fmt::format("was ended by signal {}", WTERMSIG(status))
                            : status != 0       ? fmt::format("failed with status {}", WEXITSTATUS(status))
                            // If it cannot write the end of a film, some versions print an error, but succeed.
                            : !said.empty() ? "reported an error"
                            : !has_read_all ? "ended before it had read all frames"
                                            : "";
    return said.empty() ? how : how + ": " + said;
  }

 private:
  static constexpr int kWait_ms = 20;

  static bool is_to_repeat() { return errno == EAGAIN || errno == EINTR; }

  /// Waits for a moment, or until the socket is ready.
  void wait_for(short events) const {
    stop_.check();
    pollfd socket{input_, events, 0};
    ::poll(&socket, 1, kWait_ms);
  }

  std::string last_message() const {
    std::ifstream in(fmt::format("/proc/self/fd/{}", messages_));
    std::string last;
    for (std::string line; std::getline(in, line);) last = line;
    return last;
  }

  void close() const {
    for (const int descriptor : {input_, messages_})
      if (descriptor >= 0) ::close(descriptor);
  }

  int messages_, input_ = -1;  ///< its standard error and standard input
  pid_t child_ = -1;
  base::StopPoint stop_;
};

/// Encodes images to `output`, with the options for the name of `film`.
///
/// Result     how ffmpeg failed, or an empty string
std::string encoded(const std::vector<fs::path>& images, const fs::path& film, const fs::path& output, double fps) {
  std::istringstream command(
      fmt::format("ffmpeg -nostdin -y -loglevel error -f image2pipe -framerate {} -c:v png -i pipe:0 {}", fps,
                  base::extension(film) == ".gif" ? kGif : kVideo));
  std::vector<std::string> words(std::istream_iterator<std::string>(command), {});
  words.push_back("file:" + output.string());
  Encoder encoder(std::move(words));
  for (const fs::path& image : images)
    if (!encoder.send(image)) break;
  const std::string error = encoder.finish();
  std::error_code ignored;
  return error.empty() && fs::file_size(output, ignored) == 0 ? "wrote an empty file" : error;
}

}  // namespace

pid_t start_program(const fs::path& program, std::vector<std::string> words, const std::array<int, 3>& streams,
                    int signal) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t self = ::getpid(), child = ::fork();
  if (child != 0) return child;
  ::prctl(PR_SET_PDEATHSIG, signal);
  const int null = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  int to = STDIN_FILENO;
  for (const int from : streams) ::dup2(from >= 0 ? from : null, to++);
  if (::getppid() == self) ::execvp(program.c_str(), arguments.data());
  ::_exit(127);
}

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
  if (!has_program("ffmpeg"))
    throw base::Error(base::ErrorKind::kCannotCreate,
                      fmt::format("{} cannot be created: the program ffmpeg was not found; install the package ffmpeg, "
                                  "or write an image for each frame, e.g. -o out.####.png",
                                  file_.string()));
}

Film::~Film() {
  std::error_code not_empty;
  if (lock_ < 0) return;
  fs::remove(folder_, not_empty);
  ::close(lock_);
}

void Film::open_folder() {
  std::error_code error;
  fs::create_directory(folder_, error);
  lock_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (lock_ < 0)
    throw base::Error(base::ErrorKind::kCannotCreate, fmt::format("cannot create the folder {}: {}", folder_.string(),
                                                                  error ? error.message() : std::strerror(errno)));
  // A file system without locks is no obstacle.
  if (::flock(lock_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(std::exchange(lock_, -1));
  throw base::Error(base::ErrorKind::kCannotCreate,
                    fmt::format("another command is writing {}; wait until it has ended", file_.string()));
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
  const auto fail = [&](base::ErrorKind kind, const std::string& what) {
    throw base::Error(kind, fmt::format("{}: {}; the frames are in {}, and the same command continues from them",
                                        file_.string(), what, folder_.string()));
  };
  base::AtomicFile film(file_);
  try {
    if (const std::string error = encoded(images, file_, film.temporary(), fps_); !error.empty())
      fail(base::ErrorKind::kIo, "ffmpeg " + error);
  } catch (const base::Error& error) {
    if (error.kind() != base::ErrorKind::kStopped) throw;
    fail(base::ErrorKind::kStopped, "stopped");
  }
  film.commit();
  if (keeps_frames_) return;
  std::error_code ignored;
  for (const fs::path& image : images) fs::remove(image, ignored);
}

}  // namespace orrery::cli
