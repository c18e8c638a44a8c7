// Ports for servers that cannot choose one and tell it.
#pragma once
#include <arpa/inet.h>
#include <fstream>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tandem::scenarios {

/// A port of this computer (SOCK_STREAM: TCP, SOCK_DGRAM: UDP) at which nobody listens. It lies below those that the
/// system hands out by itself, and each process of a test begins elsewhere: until it is used nobody is given it. -1:
/// none.
inline int free_port(int kind) {
  int from = 20000, below = 32768;
  std::ifstream("/proc/sys/net/ipv4/ip_local_port_range") >> below;
  if (below <= from) from = 1024;
  const int count = below - from;
  static int tried = 0;
  for (int i = 0; i < count; ++i) {
    const int port = from + (static_cast<int>(getpid()) * 37 + tried++) % count;
    const int fd = ::socket(AF_INET, kind | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_ANY);
    const bool free = ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    ::close(fd);
    if (free) return port;
  }
  return -1;
}

}  // namespace tandem::scenarios
