// The names of Boost.Asio and Boost.Beast that the window's server uses, and small things that all of it shares. Only
// the server's own files include this: Beast takes long to compile.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>  // Beast 1.74 forgets it in C++20

#include "hal/json/json.hpp"

namespace tandem::window {

namespace beast = boost::beast;
namespace http = beast::http;
namespace net = boost::asio;
namespace websocket = beast::websocket;
using tcp = net::ip::tcp;
using hal::Json;
using Clock = std::chrono::steady_clock;
using Request = http::request<http::empty_body>;
using ErrorCode = beast::error_code;

constexpr auto kRequestPatience = std::chrono::seconds(5);    // for a whole request, from the first byte waited for
constexpr auto kResponsePatience = std::chrono::seconds(15);  // for one answer to be taken

inline std::shared_ptr<const std::string> shared(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}
inline Json refusal(const std::string& why) {
  return {{"ok", false}, {"error", why}};
}
inline Clock::duration interval_of(double per_s) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / per_s));
}

/// Counts while it lives.
class Counted {
 public:
  explicit Counted(std::size_t& count) : count_(&count) { ++*count_; }
  Counted(Counted&& other) noexcept : count_(std::exchange(other.count_, nullptr)) {}
  Counted& operator=(Counted&&) = delete;
  ~Counted() {
    if (count_ != nullptr) --*count_;
  }

 private:
  std::size_t* count_;
};

}  // namespace tandem::window
