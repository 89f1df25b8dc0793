#include "canyon/lidar/velodyne/pcap.h"

#include "canyon/core/check.h"
#include "canyon/core/files/files.h"

namespace canyon::lidar::velodyne {
namespace {

constexpr std::uint32_t kMicroseconds = 0xa1b2c3d4, kNanoseconds = 0xa1b23c4d;
constexpr std::uint32_t kEthernet = 1;
constexpr std::size_t kFileHeader = 24, kRecordHeader = 16, kEthernetHeader = 14, kIpHeader = 20, kUdpHeader = 8;

std::uint32_t number(std::string_view bytes, std::size_t at, std::size_t count, bool big_endian) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = big_endian ? at + i : at + count - 1 - i;
    value = value << 8 | static_cast<unsigned char>(bytes[from]);
  }
  return value;
}

void put(std::string& out, std::uint64_t value, std::size_t count, bool big_endian) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t shift = 8 * (big_endian ? count - 1 - i : i);
    out.push_back(static_cast<char>((value >> shift) & 0xff));
  }
}

/// The UDP payload of an Ethernet frame; false if it is something else.
bool udp_payload(std::string_view frame, Datagram& out) {
  if (frame.size() < kEthernetHeader + kIpHeader + kUdpHeader) return false;
  if (number(frame, 12, 2, true) != 0x0800) return false;  // IPv4
  const std::string_view ip = frame.substr(kEthernetHeader);
  const std::size_t ip_header = 4 * (static_cast<unsigned char>(ip[0]) & 0xfu);
  const bool fragment = (number(ip, 6, 2, true) & 0x3fff) != 0;
  if ((static_cast<unsigned char>(ip[0]) >> 4) != 4 || ip_header < kIpHeader || ip[9] != 17 || fragment) return false;
  if (ip.size() < ip_header + kUdpHeader) return false;
  const std::string_view udp = ip.substr(ip_header);
  const std::size_t length = number(udp, 4, 2, true);
  if (length < kUdpHeader || length > udp.size()) return false;
  out.port = static_cast<std::uint16_t>(number(udp, 2, 2, true));
  out.payload = std::string(udp.substr(kUdpHeader, length - kUdpHeader));
  return true;
}

std::string ip_header(std::size_t payload_bytes) {
  std::string ip;
  put(ip, 0x4500, 2, true);  // version 4, five words
  put(ip, kIpHeader + kUdpHeader + payload_bytes, 2, true);
  put(ip, 0, 4, true);       // identification, no fragment
  put(ip, 0xff11, 2, true);  // time to live, UDP
  put(ip, 0, 2, true);       // checksum, below
  put(ip, 0xc0a801c9, 4, true);
  put(ip, 0xffffffff, 4, true);
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < ip.size(); i += 2) sum += number(ip, i, 2, true);
  while (sum >> 16 != 0) sum = (sum & 0xffff) + (sum >> 16);
  std::string checksum;
  put(checksum, ~sum & 0xffff, 2, true);
  return ip.replace(10, 2, checksum);
}

}  // namespace

Result<Capture> read_pcap(const std::string& path) {
  CANYON_TRY(const std::string bytes, read_text_file(path));
  const auto wrong = [&](std::string what) {
    return Error{path, 0, "", std::move(what), "a capture in pcap format with Ethernet frames"};
  };
  if (bytes.size() < kFileHeader) return wrong("too short to be a capture");
  bool big_endian = false;
  std::uint32_t magic = number(bytes, 0, 4, false);
  if (magic != kMicroseconds && magic != kNanoseconds) {
    big_endian = true;
    magic = number(bytes, 0, 4, true);
  }
  if (magic != kMicroseconds && magic != kNanoseconds) return wrong("does not begin as a capture");
  const std::uint32_t link = number(bytes, 20, 4, big_endian) & 0xffff;
  if (link != kEthernet) return wrong("link type " + std::to_string(link));
  Capture capture;
  for (std::size_t at = kFileHeader; at < bytes.size();) {
    const std::size_t left = bytes.size() - at;
    const std::size_t length = left < kRecordHeader ? 0 : number(bytes, at + 8, 4, big_endian);
    if (left < kRecordHeader || length > left - kRecordHeader) {
      capture.warning = "ends inside packet " + std::to_string(capture.datagrams.size() + capture.skipped + 1);
      break;
    }
    Datagram datagram;
    const std::uint32_t fraction = number(bytes, at + 4, 4, big_endian);
    datagram.unix_us = std::int64_t{number(bytes, at, 4, big_endian)} * 1'000'000 +
                       (magic == kMicroseconds ? fraction : fraction / 1000);
    if (udp_payload(std::string_view(bytes).substr(at + kRecordHeader, length), datagram))
      capture.datagrams.push_back(std::move(datagram));
    else
      ++capture.skipped;
    at += kRecordHeader + length;
  }
  return capture;
}

namespace {

std::string file_header() {
  std::string out;
  put(out, kMicroseconds, 4, false);
  put(out, 2, 2, false);  // version 2.4
  put(out, 4, 2, false);
  put(out, 0, 8, false);  // UTC; accuracy
  put(out, 65535, 4, false);
  put(out, kEthernet, 4, false);
  return out;
}

std::string record(const Datagram& datagram) {
  const std::size_t length = kEthernetHeader + kIpHeader + kUdpHeader + datagram.payload.size();
  CANYON_CHECK(length <= 65535, "payload of ", datagram.payload.size(), " bytes");
  std::string out;
  put(out, static_cast<std::uint64_t>(datagram.unix_us / 1'000'000), 4, false);
  put(out, static_cast<std::uint64_t>(datagram.unix_us % 1'000'000), 4, false);
  put(out, length, 4, false);
  put(out, length, 4, false);
  put(out, 0xffffffffffff, 6, true);
  put(out, 0x607688000000, 6, true);  // Velodyne's own prefix
  put(out, 0x0800, 2, true);
  out += ip_header(datagram.payload.size());
  put(out, datagram.port, 2, true);
  put(out, datagram.port, 2, true);
  put(out, kUdpHeader + datagram.payload.size(), 2, true);
  put(out, 0, 2, true);  // no checksum
  return out + datagram.payload;
}

}  // namespace

Result<PcapWriter> PcapWriter::begin(StagedFile& file) {
  CANYON_TRY_STATUS(file.write(file_header()));
  return PcapWriter(file);
}

Status PcapWriter::add(const Datagram& datagram) {
  return file_->write(record(datagram));
}

std::string pcap_text(const std::vector<Datagram>& datagrams) {
  std::string out = file_header();
  for (const Datagram& datagram : datagrams) out += record(datagram);
  return out;
}

}  // namespace canyon::lidar::velodyne
