// SPDX-License-Identifier: Apache-2.0
#include "base/read_progress.h"

#include <utility>

namespace orrery::base {
namespace {

thread_local std::shared_ptr<ReadProgress> progress_of_thread;

}  // namespace

ReadProgressScope::ReadProgressScope(std::shared_ptr<ReadProgress> progress)
    : before_(std::exchange(progress_of_thread, std::move(progress))) {}
ReadProgressScope::~ReadProgressScope() { progress_of_thread = before_; }

std::shared_ptr<ReadProgress> ReadProgressScope::current() { return progress_of_thread; }

}  // namespace orrery::base
