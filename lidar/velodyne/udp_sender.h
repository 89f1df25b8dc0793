#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "canyon/core/result.h"

namespace canyon::lidar::velodyne {

/// Sends datagrams to one address ("127.0.0.1") and port.
class UdpSender {
 public:
  static Result<UdpSender> open(const std::string& ipv4, std::uint16_t port);
  UdpSender(UdpSender&& other) noexcept;
  UdpSender& operator=(UdpSender&&) = delete;
  ~UdpSender();

  Status send(std::string_view payload) const;
  /// Sends at the sensor's own pace: `due_s` after the first that was sent in this way had its own.
  Status send_at(std::string_view payload, double due_s);

 private:
  UdpSender(int socket, std::uint32_t address, std::uint16_t port) : socket_(socket), address_(address), port_(port) {}
  int socket_;
  std::uint32_t address_;  ///< network byte order
  std::uint16_t port_;
  std::optional<std::chrono::steady_clock::time_point> start_;  ///< when due_s was 0
};

}  // namespace canyon::lidar::velodyne
