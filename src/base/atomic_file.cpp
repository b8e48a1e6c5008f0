// SPDX-License-Identifier: Apache-2.0
#include "base/atomic_file.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstddef>
#include <cstring>
#include <mutex>
#include <random>
#include <set>
#include <string>
#include <string_view>

#include "base/error.h"
#include "base/file_name.h"
#include "base/hash.h"

namespace orrery::base {
namespace {

/// An OutputFile writes its buffer when it holds this many bytes.
constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

/// Names that a signal handler must remove; in static memory because a handler must not allocate.
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
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    cannot_create(path, "it is not a regular file", EINVAL);
  return link_target(path);
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

/// Lengths of the random part of a temporary name, of its mark, and of both with the dot before them.
constexpr std::size_t kRandomLetters = 8, kMarkLetters = 6, kAddedLetters = 1 + kRandomLetters + kMarkLetters;

std::string random_letters() {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device random;
  std::uniform_int_distribution<std::size_t> letter(0, kLetters.size() - 1);
  std::string out;
  while (out.size() < kRandomLetters) out += kLetters[letter(random)];
  return out;
}

/// The mark of a temporary name that begins with `name`. It tells our names from those that users choose. It depends on
/// the machine, because some network file systems keep locks on one machine only.
std::string mark_of(const std::string& name) {
  char host[256] = "";
  ::gethostname(host, sizeof(host) - 1);
  return text_hash(host + name).substr(0, kMarkLetters);
}

bool has_mark(const std::string& name) {
  if (name.size() <= kAddedLetters || name[0] != '.' || name[name.size() - kAddedLetters] != '.') return false;
  const std::size_t end = name.size() - kMarkLetters;
  return mark_of(name.substr(0, end)) == name.substr(end);
}

/// Opens a file or folder so that it can be locked: network file systems lock only files that are open for writing.
int open_to_lock(const std::string& name) {
  constexpr int kFlags = O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
  const int file = ::open(name.c_str(), O_RDWR | kFlags);
  return file >= 0 || errno != EISDIR ? file : ::open(name.c_str(), O_RDONLY | O_DIRECTORY | kFlags);
}

/// Removes the temporaries of killed processes, once for each folder. Those of running processes are locked. One that
/// is renamed meanwhile is no longer found by its name.
void remove_leftovers(const std::filesystem::path& folder) {
  static std::mutex mutex;
  static std::set<std::filesystem::path> seen;
  const std::lock_guard lock(mutex);
  if (!seen.insert(folder).second) return;
  std::error_code ignored, end;
  for (std::filesystem::directory_iterator entry(folder, end), none; !end && entry != none; entry.increment(end)) {
    if (!has_mark(entry->path().filename().string())) continue;
    const int file = open_to_lock(entry->path().string());
    if (file < 0) continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) std::filesystem::remove_all(entry->path(), ignored);
    ::close(file);
  }
}

/// False if another process is removing the file, which it takes for a leftover. A file system without locks is no
/// obstacle: there, nothing is removed.
bool lock(int descriptor) {
  struct stat status {};
  return (::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) && ::fstat(descriptor, &status) == 0 &&
         status.st_nlink > 0;
}

/// The directory of `target`, if a file can be created in it; messages name the file `path`.
std::filesystem::path directory_for(const std::filesystem::path& path, const std::filesystem::path& target) {
  std::error_code ignored;
  const std::filesystem::path directory = folder_of(target);
  if (!std::filesystem::is_directory(directory, ignored))
    cannot_create(path, "directory " + directory.string() + " does not exist", ENOENT);
  check_replaceable(path, target);
  return directory;
}

/// The folder of temporary files, which $TMPDIR names.
std::filesystem::path temporary_folder() {
  std::error_code failed;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(failed);
  return failed ? std::filesystem::path("/tmp") : folder;
}

/// Removes a folder of files. Safe in a signal handler.
void unlink_folder(const char* name) noexcept {
  const int folder = ::open(name, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  alignas(dirent64) char block[4096];
  for (ssize_t size; (size = ::getdents64(folder, block, sizeof(block))) > 0;)
    for (ssize_t at = 0; at < size; at += reinterpret_cast<const dirent64*>(block + at)->d_reclen)
      ::unlinkat(folder, reinterpret_cast<const dirent64*>(block + at)->d_name, 0);
  ::close(folder);
  ::rmdir(name);
}

}  // namespace

std::filesystem::path link_target(std::filesystem::path path) {
  constexpr int kMaxLinks = 40;  // as in the kernel
  std::error_code error;
  for (int i = 0; i < kMaxLinks && std::filesystem::is_symlink(path, error); ++i)
    path = path.parent_path() / std::filesystem::read_symlink(path, error);
  return path;
}

Temporary::Temporary(Kind kind, const std::filesystem::path& folder, const std::string& stem,
                     const std::filesystem::path& subject) {
  constexpr int kMaxAttempts = 16;
  remove_leftovers(folder);
  // If the file system accepts a name, it must also accept the temporary name.
  const long limit = ::pathconf(folder.c_str(), _PC_NAME_MAX);
  const std::size_t longest = limit > 0 ? static_cast<std::size_t>(limit) : kLongestFileName;
  const std::size_t room = longest - std::min(longest, 1 + kAddedLetters);
  int error = EEXIST;
  for (int i = 0; i < kMaxAttempts && error == EEXIST; ++i) {
    std::string name = "." + std::string(utf8_prefix(stem, room)) + "." + random_letters();
    name += mark_of(name);
    path_ = folder / name;
    // The slot is taken first: a signal right after the file is created must find its name.
    slot_ = take_slot(path_.string());
    if (kind == Kind::kFile) {
      descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } else if (::mkdir(path_.c_str(), 0700) == 0) {
      descriptor_ = open_to_lock(path_.string());
    }
    error = descriptor_ < 0 ? errno : lock(descriptor_) ? 0 : EEXIST;
    if (error == 0) return;
    release();
  }
  const char* const remedy = kind == Kind::kFolder ? "; set $TMPDIR to another folder for temporary files" : "";
  cannot_create(subject, std::string(std::strerror(error)) + remedy, error);
}

Temporary::~Temporary() {
  std::error_code ignored;  // destructors cannot report errors
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  release();
}

bool Temporary::rename(const std::filesystem::path& target) noexcept {
  if (::rename(path_.c_str(), target.c_str()) != 0) return false;
  path_.clear();
  return true;
}

void Temporary::release() noexcept {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  free_slot(slot_);
}

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)),
      target_(rename_target(path_)),
      temporary_(Temporary::Kind::kFile, directory_for(path_, target_), target_.filename().string(), path_) {
  struct stat replaced {};
  // Keeps the permissions, but no setuid, setgid or sticky bit. The owner must write the new file and read it back.
  if (::stat(target_.c_str(), &replaced) == 0) ::fchmod(descriptor(), (replaced.st_mode & 0777) | S_IRUSR | S_IWUSR);
}

void AtomicFile::commit(bool synced) {
  // EINVAL: the file system does not support fsync.
  if (synced && ::fsync(descriptor()) != 0 && errno != EINVAL) fail_to_write(path_, errno);
  if (!temporary_.rename(target_)) fail_to_write(path_, errno);
  const int directory = synced ? ::open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
  if (directory >= 0) {
    ::fsync(directory);  // the name itself; if that fails, the file is still complete
    ::close(directory);
  }
}

void OutputFile::flush() {
  if (buffer_.size() >= kBufferBytes) write();
}

void OutputFile::write() {
  std::string_view left = buffer_;
  while (!left.empty()) {
    const ssize_t written = ::write(file_.descriptor(), left.data(), left.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_to_write(path(), errno);
    left.remove_prefix(static_cast<std::size_t>(written));
  }
  buffer_.clear();
}

void OutputFile::finish(bool synced) {
  write();
  file_.commit(synced);
}

void write_text_file(const std::filesystem::path& path, std::string_view text, bool synced) {
  OutputFile file(path);
  file.buffer() = text;
  file.finish(synced);
}

TempDir::TempDir() : folder_(Temporary::Kind::kFolder, temporary_folder(), "orrery", temporary_folder() / "orrery") {}

void remove_unfinished_files() noexcept {
  for (Slot& slot : slots)
    if (slot.armed.load(std::memory_order_acquire) && ::unlink(slot.name) != 0 && errno == EISDIR)
      unlink_folder(slot.name);
}

void check_creatable(const std::filesystem::path& path) { const AtomicFile file(path); }

}  // namespace orrery::base
