// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>

namespace orrery::base {

/// The end of what was read last from a file, as a fraction of its size; 0: not known. Thread-safe.
using ReadProgress = std::atomic<double>;

/// During its lifetime, the files that this thread opens report their progress to one place, also later and on other
/// threads. Plain files and those that gzip has compressed do.
class ReadProgressScope {
 public:
  explicit ReadProgressScope(std::shared_ptr<ReadProgress> progress);
  ~ReadProgressScope();
  ReadProgressScope(const ReadProgressScope&) = delete;
  ReadProgressScope& operator=(const ReadProgressScope&) = delete;

  /// That of the innermost scope of this thread; null: there is none.
  static std::shared_ptr<ReadProgress> current();

 private:
  const std::shared_ptr<ReadProgress> before_;
};

}  // namespace orrery::base
