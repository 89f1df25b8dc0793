// Captures of a network, datagram by datagram, as written by us and by others.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "canyon/core/output/staged.h"
#include "canyon/core/random/random.h"
#include "canyon/core/stress/looks.h"
#include "canyon/lidar/stress/subjects.h"
#include "canyon/lidar/velodyne/packet_output.h"
#include "canyon/lidar/velodyne/pcap.h"

namespace canyon::lidar {
namespace {

using stress::Looks;
using velodyne::Capture;
using velodyne::Datagram;

std::string bytes_of(std::uint64_t value, std::size_t count, bool big_endian) {
  std::string out;
  for (std::size_t i = 0; i < count; ++i)
    out += static_cast<char>(value >> (8 * (big_endian ? count - 1 - i : i)) & 255);
  return out;
}

/// A frame as Ethernet II, IPv4 and UDP have it (RFC 791 and 768), with so many words of options, and what it carries.
std::string frame_of(const std::string& payload, std::uint16_t port, std::size_t options, std::uint16_t fragment = 0,
                     std::uint16_t protocol = 17, std::uint16_t type = 0x0800) {
  std::string ip = bytes_of(0x40 + 5 + options, 1, true) + std::string(1, '\0');
  ip += bytes_of(20 + 4 * options + 8 + payload.size(), 2, true) + bytes_of(7, 2, true) + bytes_of(fragment, 2, true);
  ip += bytes_of(64, 1, true) + bytes_of(protocol, 1, true) + bytes_of(0, 2, true) + bytes_of(0x0a000001, 4, true) +
        bytes_of(0x0a000002, 4, true) + std::string(4 * options, '\1');
  const std::string udp = bytes_of(4321, 2, true) + bytes_of(port, 2, true) + bytes_of(8 + payload.size(), 2, true) +
                          bytes_of(0, 2, true) + payload;
  // Short frames are filled up to 60 bytes: what follows the datagram is none of it.
  std::string out = std::string(12, '\2') + bytes_of(type, 2, true) + ip + udp;
  if (out.size() < 60) out.resize(60, '\5');
  return out;
}

std::string payload_of(std::uint64_t k) {
  const RandomStream draws(3, "stress.captures");
  std::string out(k % 7 == 0 ? 0 : static_cast<std::size_t>(draws.uniform(0, 1300, 0, k)), '\0');
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<char>(37 * i + k);
  return out;
}

/// Written by others in either byte order and fraction of a second, with options, filling, fragments and other
/// protocols among it: every datagram as it was, to the microsecond, and each other packet counted; cut off anywhere
/// in a packet, what came before. Exact: a figure is 0 or infinite.
StressFigure of_others(bool big_endian, bool nanoseconds) {
  Looks looks;
  const std::string path =
      (std::filesystem::temp_directory_path() /
       ("canyon-capture-" + std::to_string(::getpid()) + (big_endian ? "b" : "l") + (nanoseconds ? "n" : "u")))
          .string();
  const auto word = [&](std::uint64_t value, std::size_t count) { return bytes_of(value, count, big_endian); };
  std::string text = word(nanoseconds ? 0xa1b23c4d : 0xa1b2c3d4, 4) + word(2, 2) + word(4, 2) + word(0, 8) +
                     word(65535, 4) + word(1, 4);
  std::vector<Datagram> expected;
  std::vector<std::size_t> ends;
  std::size_t others = 0;
  for (std::uint64_t k = 0; k < 60; ++k) {
    const std::int64_t us = 1'300'000'000'000'000 + static_cast<std::int64_t>(k) * 987'654'321;
    std::string frame = frame_of(payload_of(k), static_cast<std::uint16_t>(2368 + k), k % 4);
    if (k % 11 == 3) frame = frame_of(payload_of(k), 2368, 0, 0x2000), ++others;
    if (k % 11 == 5) frame = frame_of(payload_of(k), 2368, 0, 5), ++others;
    if (k % 11 == 7) frame = frame_of(payload_of(k), 2368, 0, 0, 6), ++others;
    if (k % 11 == 9) frame = frame_of(payload_of(k), 2368, 0, 0, 17, 0x86dd), ++others;
    if (k % 11 % 2 == 0 || k % 11 == 1) expected.push_back({us, static_cast<std::uint16_t>(2368 + k), payload_of(k)});
    text += word(static_cast<std::uint64_t>(us / 1'000'000), 4) +
            word(static_cast<std::uint64_t>(us % 1'000'000) * (nanoseconds ? 1000 : 1), 4) + word(frame.size(), 4) +
            word(frame.size(), 4) + frame;
    ends.push_back(text.size());
  }
  const auto look = [&](std::size_t length, std::size_t packets) {
    std::ofstream(path, std::ios::binary) << text.substr(0, length);
    const auto found = velodyne::read_pcap(path);
    looks.right(found.ok());
    if (!found) return;
    looks.right(found->datagrams.size() + found->skipped == packets &&
                found->warning.empty() == (length == ends[packets - 1]));
    if (packets == 60) looks.right(found->skipped == others && found->datagrams.size() == expected.size());
    for (std::size_t k = 0; k < found->datagrams.size() && k < expected.size(); ++k)
      looks.right(found->datagrams[k].unix_us == expected[k].unix_us && found->datagrams[k].port == expected[k].port &&
                  found->datagrams[k].payload == expected[k].payload);
  };
  look(text.size(), 60);
  look(ends[40], 41);
  look(ends[40] + 1, 41);
  look(ends[40] + 15, 41);
  look(ends[40] + 16, 41);
  look(ends[41] - 1, 41);
  for (const std::string& wrong : {text.substr(0, 23), std::string("nothing of the kind, but long enough"),
                                   text.substr(0, 20) + word(101, 4) + text.substr(24)}) {
    std::ofstream(path, std::ios::binary) << wrong;
    looks.right(!velodyne::read_pcap(path));
  }
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  return looks.figure();
}

/// As we write it: read again it is what it was, and the header of each packet sums to what its standard asks for.
StressFigure our_own() {
  Looks looks;
  const std::string path =
      (std::filesystem::temp_directory_path() / ("canyon-capture-own-" + std::to_string(::getpid()))).string();
  std::vector<Datagram> all;
  for (std::uint64_t k = 0; k < 40; ++k)
    all.push_back({1'700'000'000'999'999 + static_cast<std::int64_t>(k) * 1'000'001,
                   static_cast<std::uint16_t>(k * 1500), payload_of(k)});
  const std::string text = velodyne::pcap_text(all);
  std::ofstream(path, std::ios::binary) << text;
  const auto found = velodyne::read_pcap(path);
  looks.right(found.ok() && found->skipped == 0 && found->warning.empty() && found->datagrams.size() == all.size());
  if (found)
    for (std::size_t k = 0; k < all.size() && k < found->datagrams.size(); ++k)
      looks.right(found->datagrams[k].unix_us == all[k].unix_us && found->datagrams[k].port == all[k].port &&
                  found->datagrams[k].payload == all[k].payload);
  std::size_t at = 24;
  const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(text[i])); };
  for (const Datagram& datagram : all) {
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < 20; i += 2) sum += byte(at + 30 + i) << 8 | byte(at + 31 + i);
    while (sum >> 16 != 0) sum = (sum & 0xffff) + (sum >> 16);
    looks.right(sum == 0xffff);
    looks.right((byte(at + 32) << 8 | byte(at + 33)) == 28 + datagram.payload.size());
    at += 16 + 14 + 28 + datagram.payload.size();
  }
  looks.right(at == text.size());
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  return looks.figure();
}

/// Captures count by Unix, which knows no leap seconds: noon of the first day of 2000, 2010 and 2020 (ISO 8601 and
/// POSIX), to the microsecond in which its first packet ends.
StressFigure dated() {
  Looks looks;
  const std::string path =
      (std::filesystem::temp_directory_path() / ("canyon-capture-dated-" + std::to_string(::getpid()))).string();
  const LidarConfig config;  // a VLP-16
  for (const auto& [noon, unix_s] : {std::pair{"2000-01-01T12:00:00Z", 946'728'000},
                                     {"2010-01-01T12:00:00Z", 1'262'347'200},
                                     {"2020-01-01T12:00:00Z", 1'577'880'000}}) {
    auto output = velodyne::PacketOutput::create(config);
    auto file = StagedFile::create(path, true);
    looks.right(output.ok() && file.ok() && output->capture_to(*file).ok());
    LidarScan scan;
    scan.t = *GpsTime::parse(noon, "noon");
    scan.period_s = 0.1;
    looks.right(output->add(0, scan).ok() && file->commit().ok());
    const auto found = velodyne::read_pcap(path);
    looks.right(found.ok() && !found->datagrams.empty());
    if (found && !found->datagrams.empty())
      looks.near(static_cast<double>(found->datagrams[0].unix_us) / 1e6 - unix_s, 0.0, 0.2);
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
  return looks.figure();
}

}  // namespace

std::vector<StressCase> capture_cases() {
  StressRows rows;
  rows.of({StressGroup::kData, "captures of a network in either byte order",
           "a length of the other order, options taken for data, a fragment for a datagram",
           "each datagram as it was, each other packet counted: exact", "of the bound"});
  for (const bool big : {false, true})
    for (const bool nano : {false, true})
      rows.add(std::string("captures/") + (big ? "big_endian" : "little_endian") + (nano ? "_ns" : "_us"),
               [big, nano] { return of_others(big, nano); });
  rows.add("captures/our_own", our_own);
  rows.of({StressGroup::kData, "the date of packets in a capture",
           "leap seconds of the other sign: 36 s off, and no reader says so",
           "POSIX's count of three noons, within a scan before or after", "of the bound"});
  rows.add("captures/dated", dated);
  return rows.take();
}

}  // namespace canyon::lidar
