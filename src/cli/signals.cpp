// SPDX-License-Identifier: Apache-2.0
#include "cli/signals.h"

#include <unistd.h>
#include <csignal>

#include "base/atomic_file.h"

namespace orrery::cli {
namespace {

std::atomic<bool> stop{false}, checkpoint_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler must not lock");

void on_signal(int signal) {
  if (!stop.exchange(true)) return;
  base::remove_unfinished_files();
  _exit(128 + signal);  // as a shell reports a process ended by a signal
}

void on_failed_write(int) {}

void request_checkpoint(int) { checkpoint_requested.store(true, std::memory_order_relaxed); }

/// Installs a handler, unless the signal was ignored at the start of the process.
void handle(int signal, void (*handler)(int)) {
  struct sigaction action {
  }, before{};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(signal, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
}

void handle_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) handle(signal, on_signal);
}

}  // namespace

void prepare_signals() {
  // A handler rather than SIG_IGN, which child processes would inherit.
  for (const int signal : {SIGPIPE, SIGXFSZ}) handle(signal, on_failed_write);
  handle(SIGUSR1, request_checkpoint);
  sigset_t ours;
  sigemptyset(&ours);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) sigaddset(&ours, signal);
  sigprocmask(SIG_UNBLOCK, &ours, nullptr);
}

const std::atomic<bool>& stop_on_signals() {
  handle_signals();
  return stop;
}

void end_on_signals() {
  stop.store(true);
  handle_signals();
}

std::atomic<bool>& checkpoint_request() { return checkpoint_requested; }

}  // namespace orrery::cli
