// SPDX-License-Identifier: Apache-2.0
#include "cli/signals.h"

#include <csignal>
#include <unistd.h>

#include "base/atomic_file.h"

namespace orrery::cli {
namespace {

std::atomic<bool> stop{false}, snapshot{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may not lock");

void on_signal(int signal) {
  if (!stop.exchange(true)) return;
  base::remove_unfinished_files();
  _exit(128 + signal);  // as a shell reports a process that a signal ended
}

void on_snapshot(int) { snapshot.store(true, std::memory_order_relaxed); }

void handle_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  // A limit on the size of files is a full disk to us: the write fails and says so, instead of ending the process.
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGXFSZ, &ignore, nullptr);
}

}  // namespace

const std::atomic<bool>& stop_on_signals() {
  handle_signals();
  return stop;
}

void end_on_signals() {
  stop.store(true);
  handle_signals();
}

std::atomic<bool>& snapshot_on_signal() {
  struct sigaction action {};
  action.sa_handler = on_snapshot;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGUSR1, &action, nullptr);
  return snapshot;
}

}  // namespace orrery::cli
