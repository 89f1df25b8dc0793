#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/result.h"

namespace canyon::lidar::velodyne {

/// Sends datagrams to one address ("127.0.0.1") and port.
class UdpSender {
 public:
  static Result<UdpSender> open(const std::string& ipv4, std::uint16_t port);
  UdpSender(UdpSender&& other) noexcept;
  UdpSender& operator=(UdpSender&&) = delete;
  ~UdpSender();

  Status send(std::string_view payload) const;

 private:
  UdpSender(int socket, std::uint32_t address, std::uint16_t port) : socket_(socket), address_(address), port_(port) {}
  int socket_;
  std::uint32_t address_;  ///< network byte order
  std::uint16_t port_;
};

}  // namespace canyon::lidar::velodyne
