// SPDX-License-Identifier: Apache-2.0
#include "base/atomic_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <set>
#include <stdexcept>

#include "base/error.h"
#include "support/temp_dir.h"

namespace orrery::base {
namespace {

using support::file_bytes;
using support::TempDir;
using support::write_bytes;

/// Returns the error that `act` throws; fails the test if it throws none.
template <class Act>
Error error_of(Act act) {
  try {
    act();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  return {ErrorKind::kInternal, "no error"};
}

TEST(BaseAtomicFile, AppearsCompleteOnCommitAndNotBefore) {
  const TempDir folder;
  write_bytes(folder / "a.txt", "old");
  {
    AtomicFile file(folder / "a.txt");
    EXPECT_EQ(file.temporary().parent_path(), folder.path()) << "a rename works within one file system only";
    write_bytes(file.temporary(), "new");
    EXPECT_EQ(file_bytes(folder / "a.txt"), "old");
    file.commit();
    EXPECT_EQ(file_bytes(folder / "a.txt"), "new");
  }
  EXPECT_EQ(file_bytes(folder / "a.txt"), "new");
  EXPECT_EQ(folder.count(), 1u);
}

TEST(BaseAtomicFile, LeavesNothingWithoutCommit) {
  const TempDir folder;
  { AtomicFile file(folder / "a.txt"); }
  EXPECT_EQ(folder.count(), 0u);
}

TEST(BaseAtomicFile, LeavesNothingAfterAnException) {
  const TempDir folder;
  EXPECT_THROW(
      {
        AtomicFile file(folder / "a.txt");
        write_bytes(file.temporary(), "half");
        throw std::runtime_error("stop");
      },
      std::runtime_error);
  EXPECT_EQ(folder.count(), 0u);
}

TEST(BaseAtomicFile, ModeFollowsTheUmask) {
  const TempDir folder;
  const mode_t before = ::umask(0027);
  write_text_file(folder / "a.txt", "x");
  ::umask(before);
  struct stat status {};
  ASSERT_EQ(::stat((folder / "a.txt").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0640u);
}

TEST(BaseAtomicFile, AReplacedFileKeepsItsMode) {
  const TempDir folder;
  for (const mode_t mode : {mode_t{0600}, mode_t{0664}}) {
    write_bytes(folder / "a.txt", "old");
    ASSERT_EQ(::chmod((folder / "a.txt").c_str(), mode), 0);
    write_text_file(folder / "a.txt", "new");
    struct stat status {};
    ASSERT_EQ(::stat((folder / "a.txt").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777u, mode);
  }
}

TEST(BaseAtomicFile, AReplacedFileLosesSetuidAndSetgid) {
  const TempDir folder;
  write_bytes(folder / "a.txt", "old");
  ASSERT_EQ(::chmod((folder / "a.txt").c_str(), 06755), 0);
  write_text_file(folder / "a.txt", "new");
  struct stat status {};
  ASSERT_EQ(::stat((folder / "a.txt").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777u, 0755u);
}

constexpr uid_t kNobody = 65534;

/// Whether another user can enter the folder; temporary folders may lie in one of the user's own.
bool is_open_to_others(const TempDir& folder) {
  if (::geteuid() != 0) return true;
  if (::chmod(folder.path().c_str(), 0777) != 0 || ::seteuid(kNobody) != 0) return false;
  const bool is_open = ::faccessat(AT_FDCWD, folder.path().c_str(), W_OK | X_OK, AT_EACCESS) == 0;
  return ::seteuid(0) == 0 && is_open;
}

/// Runs `act` as a user without privileges, if this process has any.
template <class Act>
void as_plain_user(const TempDir& folder, Act act) {
  const bool is_root = ::geteuid() == 0;
  ASSERT_EQ(::chmod(folder.path().c_str(), 0777), 0);
  if (is_root) {
    ASSERT_EQ(::seteuid(kNobody), 0);
  }
  act();
  if (is_root) {
    ASSERT_EQ(::seteuid(0), 0);
  }
}

TEST(BaseAtomicFile, AWriteProtectedFileIsNotReplaced) {
  const TempDir folder;
  if (!is_open_to_others(folder)) GTEST_SKIP() << "only root can enter the temporary folder";
  as_plain_user(folder, [&] {
    write_bytes(folder / "a.txt", "old");
    ASSERT_EQ(::chmod((folder / "a.txt").c_str(), 0444), 0);
    for (const bool checks : {true, false}) {
      const Error error = error_of([&] {
        if (checks) check_creatable(folder / "a.txt");
        AtomicFile file(folder / "a.txt");
      });
      EXPECT_EQ(error.kind(), ErrorKind::kCannotCreate);
      EXPECT_NE(std::string(error.what()).find("a.txt: it exists"), std::string::npos) << error.what();
    }
  });
  EXPECT_EQ(file_bytes(folder / "a.txt"), "old");
  EXPECT_EQ(folder.count(), 1u);
}

TEST(BaseAtomicFile, AFileOfAnotherUserInAStickyFolderIsNotReplaced) {
  if (::geteuid() != 0) GTEST_SKIP() << "needs two users";
  const TempDir folder;
  if (!is_open_to_others(folder)) GTEST_SKIP() << "only root can enter the temporary folder";
  write_bytes(folder / "a.txt", "old");
  ASSERT_EQ(::chmod((folder / "a.txt").c_str(), 0666), 0);
  as_plain_user(folder, [&] { check_creatable(folder / "a.txt"); });
  ASSERT_EQ(::chmod(folder.path().c_str(), 01777), 0);
  ASSERT_EQ(::seteuid(kNobody), 0);
  const Error error = error_of([&] { check_creatable(folder / "a.txt"); });
  ASSERT_EQ(::seteuid(0), 0);
  EXPECT_EQ(error.kind(), ErrorKind::kCannotCreate);
  EXPECT_NE(std::string(error.what()).find("another user"), std::string::npos) << error.what();
}

TEST(BaseAtomicFile, MissingFolderIsNamed) {
  const TempDir folder;
  const Error error = error_of([&] { AtomicFile file(folder / "none" / "a.txt"); });
  EXPECT_EQ(error.kind(), ErrorKind::kCannotCreate);
  EXPECT_NE(std::string(error.what()).find("directory " + (folder / "none").string() + " does not exist"),
            std::string::npos)
      << error.what();
}

TEST(BaseAtomicFile, ADirectoryIsNotReplaced) {
  const TempDir folder;
  std::filesystem::create_directory(folder / "a");
  EXPECT_EQ(error_of([&] { AtomicFile file(folder / "a"); }).kind(), ErrorKind::kCannotCreate);
  EXPECT_EQ(error_of([&] { AtomicFile file((folder / "a").string() + "/"); }).kind(), ErrorKind::kCannotCreate);
}

TEST(BaseAtomicFile, APipeOrDeviceIsNotReplaced) {
  const TempDir folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(error_of([&] { AtomicFile file(folder / "pipe"); }).kind(), ErrorKind::kCannotCreate);
  EXPECT_EQ(error_of([&] { check_creatable(folder / "pipe"); }).kind(), ErrorKind::kCannotCreate);
  EXPECT_TRUE(std::filesystem::is_fifo(folder / "pipe"));
}

TEST(BaseAtomicFile, WritesTheTargetOfALink) {
  const TempDir folder;
  write_bytes(folder / "target.txt", "old");
  std::filesystem::create_symlink("target.txt", folder / "link.txt");
  write_text_file(folder / "link.txt", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(file_bytes(folder / "target.txt"), "new");
}

TEST(BaseAtomicFile, CreatesTheTargetOfADanglingLink) {
  const TempDir folder;
  std::filesystem::create_directory(folder / "scratch");
  std::filesystem::create_symlink("scratch/target.txt", folder / "link.txt");
  write_text_file(folder / "link.txt", "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_EQ(file_bytes(folder / "scratch/target.txt"), "new");

  std::filesystem::create_symlink("missing/target.txt", folder / "lost.txt");
  EXPECT_THROW(write_text_file(folder / "lost.txt", "new"), Error) << "the folder of the target does not exist";
}

TEST(BaseAtomicFile, AcceptsANameOfMaximumLength) {
  const TempDir folder;
  const std::string name(255, 'n');
  write_text_file(folder / name, "x");
  EXPECT_EQ(file_bytes(folder / name), "x");
}

TEST(BaseAtomicFile, ANameThatIsTooLongIsFoundBeforeWriting) {
  const TempDir folder;
  for (const std::string& name :
       {std::string(256, 'n'), std::string(128, 'n') + std::string(20, '/') + std::string(300, 'm')})
    EXPECT_EQ(error_of([&] { check_creatable(folder.path() / name); }).kind(), ErrorKind::kCannotCreate);
  EXPECT_EQ(error_of([&] { AtomicFile file(folder / std::string(256, 'n')); }).kind(), ErrorKind::kCannotCreate);
  EXPECT_EQ(folder.count(), 0u);
}

TEST(BaseAtomicFile, TemporaryNamesAreValidUtf8) {
  const TempDir folder;
  std::string name;
  while (name.size() < 254) name += "ä";
  const AtomicFile file(folder / name);
  const std::string temporary = file.temporary().filename().string();
  const std::string stem = temporary.substr(1, temporary.size() - 8);
  EXPECT_LE(temporary.size(), 255u);
  EXPECT_EQ(stem.size() % 2, 0u) << "a character is split";
}

TEST(BaseAtomicFile, FullDiskIsAnIoErrorThatLeavesNothing) {
  // A file size limit stands in for a full disk: write fails midway in the same way.
  const TempDir folder;
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  struct rlimit small = before;
  small.rlim_cur = 4096;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  ErrorKind kind = ErrorKind::kInternal;
  try {
    write_text_file(folder / "a.txt", std::string(10000, 'x'));
  } catch (const Error& error) {
    kind = error.kind();
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(kind, ErrorKind::kIo);
  EXPECT_EQ(folder.count(), 0u);
}

TEST(BaseAtomicFile, AMissingTemporaryFileIsAnIoError) {
  const TempDir folder;
  AtomicFile file(folder / "a.txt");
  std::filesystem::remove(file.temporary());
  EXPECT_EQ(error_of([&] { file.commit(); }).kind(), ErrorKind::kIo);
}

TEST(BaseAtomicFile, CheckLeavesNoTrace) {
  const TempDir folder;
  write_bytes(folder / "a.txt", "old");
  check_creatable(folder / "a.txt");
  check_creatable(folder / "b.txt");
  EXPECT_EQ(file_bytes(folder / "a.txt"), "old");
  EXPECT_EQ(folder.count(), 1u);
}

TEST(BaseAtomicFile, ASignalHandlerCanRemoveUnfinishedFiles) {
  const TempDir folder;
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    AtomicFile done(folder / "done.txt"), unfinished(folder / "unfinished.txt");
    done.commit();
    remove_unfinished_files();
    ::_exit(0);  // as a handler does: no destructor runs
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_EQ(folder.count(), 1u);
  EXPECT_TRUE(std::filesystem::exists(folder / "done.txt"));
}

/// Runs `act` in a child process, which then ends like one that was killed: without destructors and handlers.
template <class Act>
void in_killed_process(Act act) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    act();
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
}

std::set<std::string> names_in(const TempDir& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    names.insert(entry.path().filename().string());
  return names;
}

TEST(BaseAtomicFile, TheFilesOfAKilledProcessAreRemovedByTheNext) {
  const TempDir folder;
  in_killed_process([&] {
    const AtomicFile a(folder / "a.txt"), b(folder / "b.txt");
    write_bytes(a.temporary(), "half");
    ::_exit(0);
  });
  ASSERT_EQ(folder.count(), 2u) << "the child leaves its files";
  check_creatable(folder / "c.txt");
  EXPECT_EQ(folder.count(), 0u);
}

TEST(BaseAtomicFile, TheFilesOfARunningProcessStay) {
  const TempDir folder;
  AtomicFile running(folder / "a.txt");
  write_bytes(running.temporary(), "new");
  in_killed_process([&] {
    const AtomicFile b(folder / "b.txt");
    ::_exit(0);
  });
  ASSERT_EQ(folder.count(), 2u);
  check_creatable(folder.path() / "." / "c.txt");  // this process has not looked into a folder of this name
  EXPECT_EQ(folder.count(), 1u) << "of two files, one is left over";
  running.commit();
  EXPECT_EQ(file_bytes(folder / "a.txt"), "new");
}

TEST(BaseAtomicFile, FilesOfUsersStay) {
  const TempDir folder;
  in_killed_process([&] {
    const AtomicFile a(folder / "a.txt");
    ::_exit(0);
  });
  ASSERT_EQ(folder.count(), 1u);
  std::string other = *names_in(folder).begin();
  std::filesystem::remove(folder / other);
  other.back() = other.back() == '0' ? '1' : '0';
  const std::set<std::string> names = {".a.txt.original", ".a.txt.abcdefgh", ".a.txt.abcdefgh012345", "a.txt", other};
  for (const std::string& name : names) write_bytes(folder / name, "theirs");
  check_creatable(folder / "a.txt");
  EXPECT_EQ(names_in(folder), names);
}

/// Sets $TMPDIR for a scope.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::filesystem::path& folder) {
    if (const char* const before = std::getenv("TMPDIR")) before_ = before;
    ::setenv("TMPDIR", folder.c_str(), 1);
  }
  ~TemporaryFolder() { before_.empty() ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", before_.c_str(), 1); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

 private:
  std::string before_;
};

TEST(BaseTempDir, IsRemovedWithItsContent) {
  const TempDir folder;
  const TemporaryFolder scope(folder.path());
  {
    const base::TempDir own;
    write_bytes(own.path() / "a", "x");
    EXPECT_EQ(folder.count(), 1u);
  }
  EXPECT_EQ(folder.count(), 0u);
}

TEST(BaseTempDir, IsRemovedAfterASignalAndByTheNextProcess) {
  const TempDir folder;
  const TemporaryFolder scope(folder.path());
  for (const bool has_signal : {true, false}) {
    in_killed_process([&] {
      const base::TempDir own;
      write_bytes(own.path() / "a", "x");
      if (has_signal) remove_unfinished_files();
      ::_exit(0);
    });
    EXPECT_EQ(folder.count(), has_signal ? 0u : 1u);
  }
  { const base::TempDir next; }
  EXPECT_EQ(folder.count(), 0u);
}

TEST(BaseTempDir, AFolderThatCannotHoldFilesIsReported) {
  const TemporaryFolder scope("/proc");
  const Error error = error_of([] { base::TempDir(); });
  EXPECT_EQ(error.kind(), ErrorKind::kCannotCreate);
  EXPECT_NE(std::string(error.what()).find("$TMPDIR"), std::string::npos) << error.what();
}

TEST(BaseAtomicFile, TextIsWrittenByteForByte) {
  const TempDir folder;
  const std::string text("a\0b\r\n", 5);
  write_text_file(folder / "a.txt", text);
  EXPECT_EQ(file_bytes(folder / "a.txt"), text);
}

TEST(BaseAtomicFile, UnsyncedFilesAreReplacedWhole) {
  const support::TempDir folder;
  write_text_file(folder / "a", "first", false);
  write_text_file(folder / "a", "second", false);
  EXPECT_EQ(support::file_bytes(folder / "a"), "second");
  EXPECT_EQ(folder.count(), 1u);
}

}  // namespace
}  // namespace orrery::base
