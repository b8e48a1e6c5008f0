// SPDX-License-Identifier: Apache-2.0
// Stands in for LASzip in tests, with the same interface: its "compressed" files have the records of LAS.
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>

namespace {

/// laszip_point of laszip_api.h.
struct Point {
  std::int32_t x, y, z;
  std::uint16_t intensity;
  std::uint8_t return_number : 3, number_of_returns : 3, scan_direction_flag : 1, edge_of_flight_line : 1;
  std::uint8_t classification : 5, synthetic_flag : 1, keypoint_flag : 1, withheld_flag : 1;
  std::int8_t scan_angle_rank;
  std::uint8_t user_data;
  std::uint16_t point_source_id;
  std::int16_t extended_scan_angle;
  std::uint8_t extended_point_type : 2, extended_scanner_channel : 2, extended_classification_flags : 4;
  std::uint8_t extended_classification;
  std::uint8_t extended_return_number : 4, extended_number_of_returns : 4;
  std::uint8_t dummy[7];
  double gps_time;
  std::uint16_t rgb[4];
  std::uint8_t wave_packet[29];
  std::int32_t num_extra_bytes;
  std::uint8_t* extra_bytes;
};

struct Reader {
  std::ifstream file;
  int format = 0;
  std::string record;
  Point point{};
  std::string error;
};

template <class T>
T number(const std::string& bytes, std::size_t at) {
  T out;
  std::memcpy(&out, bytes.data() + at, sizeof out);
  return out;
}

}  // namespace

extern "C" {

int laszip_create(void** reader) {
  *reader = new Reader;
  return 0;
}

int laszip_destroy(void* reader) {
  delete static_cast<Reader*>(reader);
  return 0;
}

int laszip_get_error(void* reader, const char** error) {
  *error = static_cast<Reader*>(reader)->error.c_str();
  return 0;
}

int laszip_open_reader(void* reader, const char* file, int* is_compressed) {
  Reader& r = *static_cast<Reader*>(reader);
  r.file.open(file, std::ios::binary);
  std::string head(107, '\0');
  r.file.read(head.data(), static_cast<std::streamsize>(head.size()));
  r.format = head[104] & 0x3F;
  r.record.resize(number<std::uint16_t>(head, 105));
  r.file.seekg(number<std::uint32_t>(head, 96));
  *is_compressed = 1;
  return 0;
}

int laszip_get_point_pointer(void* reader, Point** point) {
  *point = &static_cast<Reader*>(reader)->point;
  return 0;
}

int laszip_read_point(void* reader) {
  Reader& r = *static_cast<Reader*>(reader);
  if (!r.file.read(r.record.data(), static_cast<std::streamsize>(r.record.size()))) {
    r.error = "end-of-file\ais there";
    return 1;
  }
  Point& p = r.point;
  std::memcpy(&p, r.record.data(), 16);
  const bool is_long = r.format >= 6;
  p.scan_angle_rank = static_cast<std::int8_t>(r.record[16]);
  p.user_data = static_cast<std::uint8_t>(r.record[17]);
  p.point_source_id = number<std::uint16_t>(r.record, is_long ? 20 : 18);
  if (is_long) {
    p.extended_return_number = static_cast<std::uint8_t>(r.record[14]) & 0xF;
    p.extended_number_of_returns = static_cast<std::uint8_t>(r.record[14]) >> 4;
    p.extended_classification = static_cast<std::uint8_t>(r.record[16]);
    p.extended_scan_angle = number<std::int16_t>(r.record, 18);
    p.return_number = p.number_of_returns = p.classification = 1;
    p.scan_angle_rank = 1;
  }
  const std::size_t time = is_long ? 22 : 20, color = is_long ? 30 : r.format == 2 ? 20 : 28;
  if (r.record.size() >= time + 8) p.gps_time = number<double>(r.record, time);
  if (r.record.size() >= color + 6) std::memcpy(p.rgb, r.record.data() + color, 6);
  if (r.record.size() >= 38) p.rgb[3] = number<std::uint16_t>(r.record, 36);
  return 0;
}

}  // extern "C"
