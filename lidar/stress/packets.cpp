// Packets of a real sensor's protocol at the ends of their fields: azimuth, hour, distance.
#include <cmath>
#include <cstdio>
#include <limits>

#include "canyon/core/stress_rows.h"
#include "canyon/core/units.h"
#include "canyon/lidar/lidar_config.h"
#include "canyon/lidar/stress/subjects.h"
#include "canyon/lidar/velodyne/packet.h"
#include "canyon/lidar/velodyne/packet_reader.h"
#include "canyon/lidar/velodyne/packet_writer.h"

namespace canyon::lidar {
namespace {

using stress::kEpsilon;
using velodyne::Packet;

Packet packet_at(int first_cdeg, int step_cdeg, Packet::Product product) {
  Packet p;
  p.product = product;
  for (std::size_t b = 0; b < Packet::kBlocks; ++b) {
    p.blocks[b].azimuth_cdeg = static_cast<std::uint16_t>((first_cdeg + static_cast<int>(b) * step_cdeg) % 36000);
    for (auto& channel : p.blocks[b].channels) channel = {5000, 50};
  }
  return p;
}

/// Blocks that pass 360 degrees: azimuths of beams go on evenly, within [0, 360), block by block by the step, and
/// points lie where azimuth and distance say. Sums of a few numbers of 360: 16 eps of it; points in single precision of
/// 10 m.
StressFigure azimuth_wrap(int first_cdeg, Packet::Product product) {
  const auto table = load_beam_table(velodyne::beam_table_of(product));
  if (!table.ok()) return {std::numeric_limits<double>::quiet_NaN(), 0.0};
  constexpr int kStep = 40;
  const auto returns = velodyne::decode(packet_at(first_cdeg, kStep, product), *table);
  StressFigure out{0.0, 1.0};
  if (returns.size() != 12 * 32) out.figure = 1e9;
  for (std::size_t k = 0; k < returns.size(); ++k) {
    const auto& r = returns[k];
    if (!(r.azimuth_deg >= 0.0 && r.azimuth_deg < 360.0)) out.figure = 1e9;
    if (k >= 32) {
      const double turned = std::remainder(r.azimuth_deg - returns[k - 32].azimuth_deg - 0.01 * kStep, 360.0);
      take_worst(out, std::abs(turned) / (16.0 * kEpsilon * 360.0));
    }
    const double level = std::hypot(r.point.x, r.point.y);
    const double azimuth = -std::atan2(r.point.y, r.point.x) / kDegree;
    take_worst(out,
               level * std::abs(std::remainder(azimuth - r.azimuth_deg, 360.0)) * kDegree / (2.0 * 0x1p-24 * 10.0));
  }
  return out;
}

/// Time stamps of microseconds past the hour: over the hour's end packets are as far apart as ever, to the microsecond
/// that each is cut to; and the rate of turning is what it was: 1e-3 of it.
StressFigure hour_wrap(std::uint32_t first_us) {
  std::vector<Packet> packets;
  constexpr double kApart_us = 1327.104;
  for (int k = 0; k < 76; ++k) {
    Packet p = packet_at((12 * 40 * k) % 36000, 40, Packet::Product::kVlp16);
    p.time_us =
        static_cast<std::uint32_t>(static_cast<std::uint64_t>(first_us + std::floor(kApart_us * k)) % 3'600'000'000ull);
    packets.push_back(p);
  }
  const velodyne::Timing t = velodyne::timing(packets);
  // Of 75 intervals the ends alone count: 1 us in all. The turn: 0.4 deg a block of 110.592 us.
  StressFigure out{std::abs(t.packet_us - kApart_us) / (1.0 / 75.0), 1.0};
  take_worst(out, std::abs(t.azimuth_step_deg - 0.4) / 1e-9);
  take_worst(
      out, std::abs(t.rpm / (0.4 / 360.0 / (kApart_us / 12.0 * 1e-6) * 60.0) - 1.0) / (1.0 / 75.0 / kApart_us + 1e-12));
  return out;
}

/// Scans without any return, written across an hour of UTC, and across the end of a week: each packet's stamp follows
/// the last by its 1327.104 us, cut to whole ones, and lies within the hour; the azimuths go on. A figure in us.
StressFigure written_across(GpsTime border) {
  LidarConfig config;
  config.beams = "vlp16", config.azimuth_steps = 0;
  auto writer = velodyne::PacketWriter::create(config);
  if (!writer.ok()) return {std::numeric_limits<double>::quiet_NaN(), 0.0};
  StressFigure out{0.0, 1.0};
  std::optional<Packet> before;
  for (std::int64_t k = 0; k < 10; ++k) {
    const LidarScan scan{.t = border + (-0.45 + 0.1 * static_cast<double>(k)), .period_s = 0.1, .points = {}};
    for (const auto& stamped : writer->add(k, scan)) {
      const Packet& p = stamped.packet;
      if (p.time_us >= 3'600'000'000u) out.figure = 1e9;
      if (before) {
        const std::int64_t apart = (std::int64_t{p.time_us} - before->time_us + 3'600'000'000) % 3'600'000'000;
        take_worst(out, std::abs(static_cast<double>(apart) - 1327.104));
        // 12 blocks of two cycles at 10 Hz: 3600 deg/s * 1.327104 ms = 4.7776 deg.
        const int turned = (p.blocks[0].azimuth_cdeg - before->blocks[0].azimuth_cdeg + 36000) % 36000;
        take_worst(out, std::abs(turned - 477.75744) - 0.5);
      }
      before = p;
    }
  }
  return before ? out : StressFigure{std::numeric_limits<double>::infinity(), 1.0};
}

/// Bytes and back at the ends of every field; other lengths, flags, modes and products are no packet. A figure counts.
StressFigure bytes() {
  StressFigure out;
  for (const std::uint16_t azimuth : {0, 35999})
    for (const std::uint16_t distance : {0, 1, 65535})
      for (const std::uint32_t time : {0u, 3'599'999'999u, 0xffffffffu}) {
        Packet p = packet_at(azimuth, 0, Packet::Product::kHdl32e);
        p.time_us = time, p.mode = Packet::Mode::kDual;
        for (auto& block : p.blocks)
          for (auto& channel : block.channels) channel = {distance, 255};
        const auto back = Packet::parse(p.bytes());
        out.figure += back && back->bytes() == p.bytes() && back->time_us == time &&
                              back->blocks[11].channels[31].distance == distance &&
                              back->blocks[0].azimuth_cdeg == azimuth
                          ? 0.0
                          : 1.0;
      }
  const std::string good = packet_at(100, 40, Packet::Product::kVlp16).bytes();
  const auto none = [&](std::string text) { out.figure += Packet::parse(text) ? 1.0 : 0.0; };
  none(""), none(good.substr(1)), none(good + "x");
  for (const std::size_t at : {std::size_t{0}, std::size_t{1100}, std::size_t{1204}, std::size_t{1205}}) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 0x80);
    none(bad);
  }
  std::string turned = good;
  turned[2] = static_cast<char>(0xa0), turned[3] = static_cast<char>(0x8c);  // 36000
  none(turned);
  return out;
}

}  // namespace

std::vector<StressCase> packet_cases() {
  StressRows rows;
  rows.of({StressGroup::kGeometry, "blocks of a packet across 360 degrees",
           "the step from 359.9 to 0.3 taken as -359.6: points turned about the sensor",
           "the same step everywhere, within [0, 360): 16 eps 360; points to two half units of 10 m", "of the bound"});
  for (const int first : {0, 35700, 35999}) {
    rows.add("packets/vlp16_from_azimuth_" + std::to_string(first),
             [first] { return azimuth_wrap(first, Packet::Product::kVlp16); });
    rows.add("packets/hdl32e_from_azimuth_" + std::to_string(first),
             [first] { return azimuth_wrap(first, Packet::Product::kHdl32e); });
  }
  rows.of({StressGroup::kLong, "time stamps across the hour",
           "3.6e9 us back in one packet: a sensor that turns backwards", "1327.104 us apart, 1 us in 75",
           "of the bound"});
  rows.add("packets/timing_within_the_hour", [] { return hour_wrap(1'000'000'000u); })
      .add("packets/timing_across_the_hour", [] { return hour_wrap(3'599'950'000u); });
  rows.of({StressGroup::kLong, "packets of empty scans, written across hour and week",
           "a count of microseconds past 32 bits; a scan without points without packets",
           "1327.104 us apart to a microsecond, the azimuth to half a hundredth", "us"});
  // 2010: GPS is 15 s ahead, so that an hour of UTC ends 15 s past one of GPS time.
  rows.add("packets/written_across_the_hour",
           [] { return written_across(GpsTime::from_calendar(2010, 7, 1, 13, 0, 15.0)); })
      .add("packets/written_across_the_week", [] { return written_across(GpsTime::from_week_sow(2048, 0.0)); });
  rows.of({StressGroup::kData, "a packet at the ends of its fields, and what is none",
           "signs of bytes, an azimuth of 360", "the same bytes, or refused", "wrong"});
  rows.add("packets/bytes_at_their_ends", bytes);
  return rows.take();
}

}  // namespace canyon::lidar
