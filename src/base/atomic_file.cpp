// SPDX-License-Identifier: Apache-2.0
#include "base/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstddef>
#include <cstring>
#include <random>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/file_name.h"

namespace orrery::base {
namespace {

/// An OutputFile writes its buffer when it holds this many bytes.
constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

/// File names that a signal handler must unlink; in static memory because a handler must not allocate.
struct Slot {
  std::atomic<bool> taken{false}, armed{false};
  char name[PATH_MAX];
};
std::array<Slot, 16> slots;

int take_slot(const std::string& name) {
  for (std::size_t i = 0; i < slots.size(); ++i) {
    bool expected = false;
    if (name.size() >= sizeof(slots[i].name) || !slots[i].taken.compare_exchange_strong(expected, true)) continue;
    std::memcpy(slots[i].name, name.c_str(), name.size() + 1);
    slots[i].armed.store(true, std::memory_order_release);
    return static_cast<int>(i);
  }
  return -1;  // all slots are taken: a signal leaves this file behind
}

void free_slot(int index) noexcept {
  if (index < 0) return;
  slots[static_cast<std::size_t>(index)].armed.store(false, std::memory_order_release);
  slots[static_cast<std::size_t>(index)].taken.store(false, std::memory_order_release);
}

[[noreturn]] void cannot_create(const std::filesystem::path& path, const std::string& reason, int number) {
  throw FileError(ErrorKind::kCannotCreate, "cannot create " + path.string() + ": " + reason, path, number);
}

/// Returns the path to rename onto: the target of a symbolic link, so that the link itself stays. Devices and pipes are
/// refused, because a rename would replace /dev/null by a regular file.
std::filesystem::path rename_target(const std::filesystem::path& path) {
  std::error_code ignored;
  struct stat entry {};
  // Finds names that are too long, loops of links and unsearchable directories before rendering, not after.
  if (::lstat(path.c_str(), &entry) != 0 && errno != ENOENT && errno != ENOTDIR)
    cannot_create(path, std::strerror(errno), errno);
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (path.filename().empty() || std::filesystem::is_directory(status))
    cannot_create(path, "it is a directory", EISDIR);
  if (!std::filesystem::exists(status)) return link_target(path);
  if (!std::filesystem::is_regular_file(status)) cannot_create(path, "it is not a regular file", EINVAL);
  if (!std::filesystem::is_symlink(path, ignored)) return path;
  std::filesystem::path target = std::filesystem::canonical(path, ignored);
  return target.empty() ? path : target;
}

/// Refuses a file that a rename must not, or cannot, replace: write-protected or immutable, or of another user in a
/// directory such as /tmp.
void check_replaceable(const std::filesystem::path& path, const std::filesystem::path& target) {
  struct stat file {
  }, directory{};
  if (::stat(target.c_str(), &file) != 0) return;
  if (::faccessat(AT_FDCWD, target.c_str(), W_OK, AT_EACCESS) != 0)
    cannot_create(path, std::string("it exists and cannot be written: ") + std::strerror(errno), errno);
  if (::stat(folder_of(target).c_str(), &directory) != 0 || (directory.st_mode & S_ISVTX) == 0) return;
  const uid_t user = ::geteuid();
  if (user != 0 && user != file.st_uid && user != directory.st_uid)
    cannot_create(path, "it belongs to another user, and its directory has the sticky bit", EPERM);
}

/// A new, empty file, and its slot in the table that a signal handler unlinks.
struct NewFile {
  std::string name;
  int slot = -1;
};

/// Length of the random part of a temporary name.
constexpr std::size_t kRandomLetters = 8;

std::string random_letters() {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device random;
  std::uniform_int_distribution<std::size_t> letter(0, kLetters.size() - 1);
  std::string out;
  while (out.size() < kRandomLetters) out += kLetters[letter(random)];
  return out;
}

/// Creates a file in the directory of `target`; messages name it `path`.
NewFile create_beside(const std::filesystem::path& path, const std::filesystem::path& target) {
  constexpr int kMaxAttempts = 16;
  std::error_code ignored;
  const std::filesystem::path directory = folder_of(target);
  if (!std::filesystem::is_directory(directory, ignored))
    cannot_create(path, "directory " + directory.string() + " does not exist", ENOENT);
  check_replaceable(path, target);
  // If the file system accepts a name, it must also accept the temporary name.
  const long limit = ::pathconf(directory.c_str(), _PC_NAME_MAX);
  const std::size_t longest = limit > 0 ? static_cast<std::size_t>(limit) : kLongestFileName;
  const std::size_t room = longest - std::min(longest, 2 + kRandomLetters);
  const std::string stem(utf8_prefix(target.filename().string(), room));
  for (int i = 0; i < kMaxAttempts; ++i) {
    NewFile file;
    file.name = (directory / ("." + stem + "." + random_letters())).string();
    // The slot is taken first: a signal right after the file is created must find its name.
    file.slot = take_slot(file.name);
    const int descriptor = ::open(file.name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      struct stat replaced {};
      // Keeps the permissions, but no setuid, setgid or sticky bit. The owner must write the new file and read it back.
      if (::stat(target.c_str(), &replaced) == 0) ::fchmod(descriptor, (replaced.st_mode & 0777) | S_IRUSR | S_IWUSR);
      ::close(descriptor);
      return file;
    }
    const int error = errno;
    free_slot(file.slot);
    if (error != EEXIST) cannot_create(path, std::strerror(error), error);
  }
  cannot_create(path, std::strerror(EEXIST), EEXIST);
}

}  // namespace

std::filesystem::path link_target(std::filesystem::path path) {
  constexpr int kMaxLinks = 40;  // as in the kernel
  std::error_code error;
  for (int i = 0; i < kMaxLinks && std::filesystem::is_symlink(path, error); ++i)
    path = path.parent_path() / std::filesystem::read_symlink(path, error);
  return path;
}

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)), target_(rename_target(path_)) {
  const NewFile file = create_beside(path_, target_);
  temporary_ = file.name;
  slot_ = file.slot;
}

AtomicFile::~AtomicFile() {
  if (!committed_) ::unlink(temporary_.c_str());
  free_slot(slot_);
}

void AtomicFile::commit() {
  const int file = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) fail_to_write(path_, errno);
  const int synced = ::fsync(file);
  const int error = errno;
  ::close(file);
  if (synced != 0 && error != EINVAL) fail_to_write(path_, error);  // EINVAL: the file system does not support fsync
  commit_unsynced();
  const int directory = ::open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory >= 0) {
    ::fsync(directory);  // the name itself; if that fails, the file is still complete
    ::close(directory);
  }
}

void AtomicFile::commit_unsynced() {
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail_to_write(path_, errno);
  committed_ = true;
}

OutputFile::OutputFile(const std::filesystem::path& path)
    : path_(path), file_(path), descriptor_(::open(file_.temporary().c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC)) {}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::flush() {
  if (buffer_.size() >= kBufferBytes) write();
}

void OutputFile::write() {
  std::string_view left = buffer_;
  while (!left.empty()) {
    const ssize_t written = ::write(descriptor_, left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_to_write(path_, errno);
    left.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void OutputFile::finish(bool synced) {
  write();
  const int status = ::close(descriptor_);
  descriptor_ = -1;
  if (status != 0) fail_to_write(path_, errno);
  synced ? file_.commit() : file_.commit_unsynced();
}

void write_text_file(const std::filesystem::path& path, std::string_view text, bool synced) {
  OutputFile file(path);
  file.buffer() = text;
  file.finish(synced);
}

void remove_unfinished_files() noexcept {
  for (Slot& slot : slots)
    if (slot.armed.load(std::memory_order_acquire)) ::unlink(slot.name);
}

void check_creatable(const std::filesystem::path& path) {
  const NewFile file = create_beside(path, rename_target(path));
  ::unlink(file.name.c_str());
  free_slot(file.slot);
}

}  // namespace orrery::base
