#include "canyon/lidar/velodyne/udp_sender.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

#include "canyon/core/process/progress.h"

namespace canyon::lidar::velodyne {

Result<UdpSender> UdpSender::open(const std::string& ipv4, std::uint16_t port) {
  in_addr address{};
  if (inet_pton(AF_INET, ipv4.c_str(), &address) != 1)
    return Error{"", 0, "udp", '"' + ipv4 + "\" is not an address", "an IPv4 address such as 127.0.0.1"};
  const int handle = socket(AF_INET, SOCK_DGRAM, 0);
  if (handle < 0) return Error{"", 0, "udp", std::string("no socket: ") + std::strerror(errno), "", 1};
  const int yes = 1;
  setsockopt(handle, SOL_SOCKET, SO_BROADCAST, &yes, sizeof yes);
  return UdpSender(handle, address.s_addr, port);
}

UdpSender::UdpSender(UdpSender&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), address_(other.address_), port_(other.port_) {}

UdpSender::~UdpSender() {
  if (socket_ >= 0) close(socket_);
}

Status UdpSender::send_at(std::string_view payload, double due_s) {
  const auto due =
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(due_s));
  if (!start_) start_ = std::chrono::steady_clock::now() - due;
  std::this_thread::sleep_until(*start_ + due);
  throw_if_cancelled();
  return send(payload);
}

Status UdpSender::send(std::string_view payload) const {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port_);
  to.sin_addr.s_addr = address_;
  const auto sent =
      sendto(socket_, payload.data(), payload.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  if (sent != static_cast<ssize_t>(payload.size()))
    return Error{"", 0, "udp", std::string("could not send: ") + std::strerror(errno), "", 1};
  return Ok{};
}

}  // namespace canyon::lidar::velodyne
