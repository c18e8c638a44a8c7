#include "bridges/link/link_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>

#include "bridges/link/permitted_link.hpp"
#include "bridges/link/serial_link.hpp"
#include "bridges/link/tcp_link.hpp"

namespace tandem::bridges {
namespace {

struct SchemeRow {
  LinkScheme scheme;
  std::string_view name;
  std::string_view example;
  std::string_view target;     // what comes after the colon
  std::uint32_t default_rate;  // 0: takes none
};

constexpr std::array<SchemeRow, 6> kSchemes = {{
    {LinkScheme::Serial, "serial", "serial:/dev/ttyUSB0@115200", "device", 115200},
    {LinkScheme::Tcp, "tcp", "tcp:192.168.1.20:3000", "host", 0},
    {LinkScheme::Slcan, "slcan", "slcan:/dev/ttyACM0@1000000", "device", 1000000},
    {LinkScheme::Can, "can", "can:can0", "CAN interface", 0},
    {LinkScheme::Lcm, "lcm", "lcm:udpm://239.255.76.67:7667?ttl=0", "LCM url", 0},
    {LinkScheme::Pty, "pty", "pty:ep0", "name of the pseudo-terminal", 0},
}};

constexpr std::array<std::uint32_t, 20> kSerialRates = {1200,    2400,    4800,    9600,    19200,   38400,  57600,
                                                        115200,  230400,  460800,  500000,  576000,  921600, 1000000,
                                                        1152000, 1500000, 2000000, 2500000, 3000000, 4000000};

const SchemeRow& row_of(LinkScheme scheme) noexcept {
  return kSchemes[static_cast<std::size_t>(scheme)];
}

std::string examples() {
  std::string text;
  for (const SchemeRow& row : kSchemes) text += (text.empty() ? "" : ", ") + std::string(row.example);
  return text;
}

std::uint32_t nearest_rate(std::uint32_t rate) noexcept {
  const auto distance = [rate](std::uint32_t r) { return r > rate ? r - rate : rate - r; };
  return *std::min_element(kSerialRates.begin(), kSerialRates.end(),
                           [&](std::uint32_t a, std::uint32_t b) { return distance(a) < distance(b); });
}

/// Splits "@rate" off `address.target`.
hal::Status read_rate(std::string_view text, LinkAddress& address) {
  const std::size_t at = address.target.rfind('@');
  if (at == std::string::npos) return {};
  const std::string digits = address.target.substr(at + 1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), address.rate);
  if (error != std::errc{} || end != digits.data() + digits.size() || address.rate == 0) {
    return hal::Error{"link '" + std::string(text) + "': '" + digits +
                      "' after the @ is not a rate; write a number such as @" +
                      std::to_string(row_of(address.scheme).default_rate)};
  }
  address.target.resize(at);
  return {};
}

}  // namespace

std::string_view scheme_name(LinkScheme scheme) noexcept {
  return row_of(scheme).name;
}

std::string to_text(const LinkAddress& address) {
  std::string text = std::string(scheme_name(address.scheme)) + ":" + address.target;
  if (address.rate != 0) text += "@" + std::to_string(address.rate);
  return text;
}

std::string absolute_link(std::string_view text) {
  auto parsed = parse_link(text);
  if (!parsed.ok()) return std::string(text);
  LinkAddress address = std::move(parsed).value();
  if (address.scheme != LinkScheme::Serial && address.scheme != LinkScheme::Slcan) return std::string(text);
  std::error_code error;
  const auto path = std::filesystem::absolute(address.target, error);
  if (!error) address.target = path.string();
  return to_text(address);
}

hal::Result<LinkAddress> parse_link(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) {
    return hal::Error{"link '" + std::string(text) + "' has no scheme; write for example " + examples()};
  }
  const std::string_view scheme = text.substr(0, colon);
  const auto row = std::find_if(kSchemes.begin(), kSchemes.end(), [&](const SchemeRow& r) { return r.name == scheme; });
  if (row == kSchemes.end()) {
    return hal::Error{"link '" + std::string(text) + "': unknown scheme '" + std::string(scheme) +
                      "'; known: " + examples()};
  }
  LinkAddress address{row->scheme, std::string(text.substr(colon + 1)), row->default_rate};
  if (row->default_rate != 0) {
    if (const hal::Status read = read_rate(text, address); !read) return read.error();
  }
  if (address.target.empty()) {
    return hal::Error{"link '" + std::string(text) + "': no " + std::string(row->target) + " after '" +
                      std::string(scheme) + ":'; write for example " + std::string(row->example)};
  }
  if (row->scheme == LinkScheme::Serial &&
      !std::binary_search(kSerialRates.begin(), kSerialRates.end(), address.rate)) {
    return hal::Error{"link '" + std::string(text) + "': serial devices do not have " + std::to_string(address.rate) +
                      " baud; the nearest they have is " + std::to_string(nearest_rate(address.rate))};
  }
  return address;
}

hal::Result<LinkOpener> byte_link_opener(const LinkAddress& address, const LinkTerms& terms) {
  if (address.scheme == LinkScheme::Tcp) {
    const auto endpoint = parse_endpoint("tcp", address.target);
    if (!endpoint.ok()) return endpoint.error();
    return permitted([e = endpoint.value()] { return TcpLink::connect(e); }, terms.permit);
  }
  if (address.scheme != LinkScheme::Serial) {
    return hal::Error{"link '" + to_text(address) +
                      "' does not carry a robot's bytes from here; use serial:DEVICE@BAUD or tcp:HOST:PORT"};
  }
  return permitted([address, beside = terms.beside] { return SerialLink::open(address, beside); }, terms.permit);
}

}  // namespace tandem::bridges
