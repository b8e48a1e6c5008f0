// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

/// Declarations of the room's types, for headers that only name them.
namespace orrery::data {

enum class Format;

class ByteSource;
class DataFile;
class Faults;

struct Column;
struct FrameInfo;
struct OpenOptions;
struct Signature;
struct Table;

/// The bytes of a file, shared by its readers.
using Bytes = std::shared_ptr<const ByteSource>;

}  // namespace orrery::data
