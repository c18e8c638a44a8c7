#include "bridges/link/device.hpp"

#include <arpa/inet.h>
#include <array>
#include <filesystem>
#include <fstream>
#include <linux/can.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include "bridges/link/link_text.hpp"
#include "bridges/link/tcp_link.hpp"

namespace tandem::bridges {
namespace {

std::string target_of(const std::string& link) {
  std::array<char, 256> text{};
  const ssize_t n = ::readlink(link.c_str(), text.data(), text.size());
  return n > 0 ? std::string(text.data(), static_cast<std::size_t>(n)) : "";
}

std::string number_of(const struct stat& info) {
  return std::to_string(major(info.st_rdev)) + ":" + std::to_string(minor(info.st_rdev));
}

std::optional<std::string> terminal(const std::string& path) {
  std::error_code error;
  const auto real = std::filesystem::canonical(path, error);
  struct stat info {};
  if (error || ::stat(real.c_str(), &info) != 0) return std::nullopt;
  return S_ISCHR(info.st_mode) ? real.string() + " " + number_of(info) : real.string();
}

std::optional<std::string> address_text(const sockaddr_storage& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (address.ss_family == AF_INET) {
    const auto& v4 = reinterpret_cast<const sockaddr_in&>(address);
    if (::inet_ntop(AF_INET, &v4.sin_addr, text.data(), text.size()) == nullptr) return std::nullopt;
    return std::string(text.data()) + ":" + std::to_string(ntohs(v4.sin_port));
  }
  if (address.ss_family != AF_INET6) return std::nullopt;
  const auto& v6 = reinterpret_cast<const sockaddr_in6&>(address);
  if (::inet_ntop(AF_INET6, &v6.sin6_addr, text.data(), text.size()) == nullptr) return std::nullopt;
  std::string host(text.data());
  if (v6.sin6_scope_id != 0) host += "%" + std::to_string(v6.sin6_scope_id);
  return "[" + host + "]:" + std::to_string(ntohs(v6.sin6_port));
}

/// An interface is of a network namespace: can0 of a container is not can0 of its host.
std::string interface_text(const std::string& name) {
  return name + " of " + target_of("/proc/self/ns/net");
}

std::optional<std::string> host_address(const Endpoint& endpoint) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(endpoint.host.c_str(), std::to_string(endpoint.port).c_str(), &hints, &found) != 0)
    return std::nullopt;
  sockaddr_storage address{};
  std::copy_n(reinterpret_cast<const char*>(found->ai_addr), found->ai_addrlen, reinterpret_cast<char*>(&address));
  ::freeaddrinfo(found);
  return address_text(address);
}

std::string line_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

}  // namespace

std::optional<std::string> device_of(int descriptor) {
  struct stat info {};
  if (descriptor < 0 || ::fstat(descriptor, &info) != 0) return std::nullopt;
  if (S_ISCHR(info.st_mode)) {
    const std::string path = target_of("/proc/self/fd/" + std::to_string(descriptor));
    if (path.empty()) return std::nullopt;
    // A device that was unplugged while it is open: "/dev/ttyUSB0 (deleted)".
    return path.substr(0, path.find(" (deleted)")) + " " + number_of(info);
  }
  if (!S_ISSOCK(info.st_mode)) return std::nullopt;
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (::getpeername(descriptor, reinterpret_cast<sockaddr*>(&address), &size) == 0 && address.ss_family != AF_CAN)
    return address_text(address);
  size = sizeof address;
  if (::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) != 0 || address.ss_family != AF_CAN)
    return std::nullopt;
  std::array<char, IF_NAMESIZE> name{};
  const auto index = static_cast<unsigned>(reinterpret_cast<const sockaddr_can&>(address).can_ifindex);
  if (::if_indextoname(index, name.data()) == nullptr) return std::nullopt;
  return interface_text(name.data());
}

std::optional<std::string> device_at(std::string_view link) {
  constexpr std::string_view kWifi = "epuck-tcp:";  // of bridges/epuck/link.hpp, with its usual port
  if (link.starts_with(kWifi)) {
    const auto endpoint = parse_endpoint("epuck-tcp", link.substr(kWifi.size()), 1000);
    return endpoint.ok() ? host_address(endpoint.value()) : std::nullopt;
  }
  const auto parsed = parse_link(link);
  if (!parsed.ok()) return std::string(link);
  const LinkAddress& address = parsed.value();
  switch (address.scheme) {
    case LinkScheme::Serial:
    case LinkScheme::Slcan:
      return terminal(address.target);
    case LinkScheme::Tcp: {
      const auto endpoint = parse_endpoint("tcp", address.target, 33333);
      return endpoint.ok() ? host_address(endpoint.value()) : std::nullopt;
    }
    case LinkScheme::Can:
      if (::if_nametoindex(address.target.c_str()) == 0) return std::nullopt;
      return interface_text(address.target);
    case LinkScheme::Lcm:
    case LinkScheme::Pty:
      break;
  }
  return std::string(link);
}

std::optional<std::string> serial_number_of(int descriptor) {
  struct stat info {};
  if (descriptor < 0 || ::fstat(descriptor, &info) != 0 || !S_ISCHR(info.st_mode)) return std::nullopt;
  const std::filesystem::path node = "/sys/dev/char/" + number_of(info);
  if (const std::string bluetooth = line_of(node / "address"); !bluetooth.empty()) return "Bluetooth " + bluetooth;
  std::error_code error;
  std::filesystem::path at = std::filesystem::canonical(node / "device", error);
  // tty -> interface -> USB device: its `serial` lies at most a few folders up.
  for (int up = 0; !error && up < 4 && at.has_relative_path(); ++up, at = at.parent_path()) {
    if (!std::filesystem::exists(at / "idVendor", error)) continue;
    const std::string serial = line_of(at / "serial");
    if (!serial.empty()) return "USB " + serial;
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace tandem::bridges
