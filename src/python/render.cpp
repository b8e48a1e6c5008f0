// SPDX-License-Identifier: Apache-2.0
#include "python/render.h"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/stop_point.h"
#include "job/run_job.h"
#include "python/arrays.h"
#include "python/picture.h"
#include "render/settings.h"

namespace py = pybind11;

namespace orrery::python {
namespace {

/// Interval at which the calling thread checks for signals.
constexpr std::chrono::milliseconds kPoll{100};

/// Messages from the render to the calling thread.
class Messages {
 public:
  void set_progress(const render::Progress& progress) {
    const std::scoped_lock lock(mutex_);
    progress_ = progress;  // delivered at the next kPoll
  }
  void add_warning(const base::Diagnostic& warning) {
    const std::scoped_lock lock(mutex_);
    warnings_.push_back(base::formatted(warning));
    changed_.notify_one();
  }
  void end() {
    const std::scoped_lock lock(mutex_);
    ended_ = true;
    changed_.notify_one();
  }
  /// Waits for the next message, but not longer than kPoll. Returns true if the render has ended.
  bool take(std::optional<render::Progress>& progress, std::vector<std::string>& warnings) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kPoll, [this] { return ended_ || !warnings_.empty(); });
    progress = std::exchange(progress_, {});
    warnings = std::exchange(warnings_, {});
    return ended_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<render::Progress> progress_;
  std::vector<std::string> warnings_;
  bool ended_ = false;
};

/// The renders of this process.
struct ActiveRenders {
  std::mutex mutex;
  std::condition_variable changed;
  std::set<std::atomic<bool>*> cancels;
  std::thread::id exiting;  // the thread that ends the interpreter; its own renders are not stopped
};
ActiveRenders& active_renders() {
  static auto* const all = new ActiveRenders;  // outlives all threads
  return *all;
}

class RenderEntry {
 public:
  explicit RenderEntry(std::atomic<bool>& cancel) : cancel_(&cancel) {
    const std::scoped_lock lock(active_renders().mutex);
    active_renders().cancels.insert(cancel_);
    *cancel_ = is_exiting();
  }
  ~RenderEntry() { remove(); }
  RenderEntry(const RenderEntry&) = delete;
  RenderEntry& operator=(const RenderEntry&) = delete;

  /// Whether stop_renders() has been called and stops this render.
  bool stopped_at_exit() const {
    const std::scoped_lock lock(active_renders().mutex);
    return is_exiting();
  }
  void remove() {
    const std::scoped_lock lock(active_renders().mutex);
    active_renders().cancels.erase(cancel_);
    active_renders().changed.notify_all();
  }

 private:
  static bool is_exiting() {
    return active_renders().exiting != std::thread::id() && active_renders().exiting != std::this_thread::get_id();
  }
  std::atomic<bool>* cancel_;
};

/// Ends a daemon thread as CPython 3.14 does while the interpreter finalizes: it never runs again. If it returned to
/// Python, it would print a traceback, and a thread that holds the lock of sys.stderr at that moment aborts the
/// process.
[[noreturn]] void hang_thread(RenderEntry& entry) {
  entry.remove();
  for (;;) pause();
}

/// Passes messages on to Python. Errors of Python are thrown.
void deliver(const std::optional<render::Progress>& progress, const std::vector<std::string>& warnings,
             const py::object& on_progress, const py::object& on_warning) {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  for (const std::string& warning : warnings) on_warning(str_of(warning));
  if (!progress || on_progress.is_none()) return;
  const double total = static_cast<double>(progress->samples_total);
  const double fraction = total > 0 ? static_cast<double>(progress->samples_done) / total : 0;
  on_progress(fraction, progress->samples_done, progress->samples_total, progress->seconds, progress->goal);
}

}  // namespace

void run(const std::function<void(const job::Hooks&)>& work, const py::object& on_progress,
         const py::object& on_warning) {
  Messages messages;
  std::atomic<bool> cancel{false};
  RenderEntry entry(cancel);
  std::exception_ptr failure, python_failure;
  {
    const py::gil_scoped_release released;
    std::thread worker([&] {
      try {
        const base::StopScope scope(&cancel);
        job::Hooks hooks;
        hooks.cancel = &cancel;
        hooks.on_progress = [&](const render::Progress& p) { messages.set_progress(p); };
        hooks.on_warning = [&](const base::Diagnostic& d) { messages.add_warning(d); };
        work(hooks);
      } catch (...) {
        failure = std::current_exception();
      }
      messages.end();
    });
    for (bool ended = false; !ended;) {
      std::optional<render::Progress> progress;
      std::vector<std::string> warnings;
      ended = messages.take(progress, warnings);
      if (python_failure || entry.stopped_at_exit()) continue;
      const py::gil_scoped_acquire acquired;
      try {
        deliver(progress, warnings, on_progress, on_warning);
      } catch (...) {
        python_failure = std::current_exception();
        cancel = true;
      }
    }
    worker.join();
    if (entry.stopped_at_exit()) hang_thread(entry);
  }
  if (python_failure) std::rethrow_exception(python_failure);
  if (failure) std::rethrow_exception(failure);
}

Picture render(const std::function<job::Job()>& make_job, const py::object& on_progress, const py::object& on_warning) {
  job::Rendering rendering;
  const auto work = [&](const job::Hooks& hooks) {
    job::Job job = make_job();
    job.hooks = hooks;
    rendering = job::render_in_memory(job);
  };
  run(work, on_progress, on_warning);
  const std::uint64_t paths = rendering.report.render.paths;
  if (!on_progress.is_none()) on_progress(1.0, paths, paths, rendering.report.render.render_s, "");
  if (!rendering.report.target_missed.empty()) on_warning(str_of(rendering.report.target_missed));
  return Picture(std::move(rendering));
}

void stop_renders() {
  const py::gil_scoped_release released;
  std::unique_lock lock(active_renders().mutex);
  active_renders().exiting = std::this_thread::get_id();
  for (std::atomic<bool>* const cancel : active_renders().cancels) *cancel = true;
  active_renders().changed.wait(lock, [] { return active_renders().cancels.empty(); });
}

}  // namespace orrery::python
