#include <algorithm>
#include <arpa/inet.h>
#include <atomic>
#include <chrono>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include "tests/scenarios/process.hpp"
#include "window/window.hpp"
#include "window/wire/client.hpp"

namespace tandem::window {
namespace {

using hal::Json;
using scenarios::eventually;
using namespace std::chrono_literals;

constexpr double kPatience_s = 60.0;

std::unique_ptr<Window> open_window(const WindowOptions& options = {}) {
  auto window = Window::open(options);
  EXPECT_TRUE(window.ok()) << (window.ok() ? "" : window.error().message);
  return std::move(window).value();
}

Client join(const Window& window) {
  auto client = Client::connect(window.address());
  EXPECT_TRUE(client.ok()) << (client.ok() ? "" : client.error().message);
  return std::move(client).value();
}

Frame frame_of(std::size_t robots, hal::Tick tick = 1) {
  auto members = std::make_shared<FrameMembers>();
  members->number = 1;
  members->json = Json::object();
  members->first_led.assign(robots + 1, 0);
  Frame frame;
  frame.members = std::move(members);
  frame.tick = tick;
  frame.x_m.assign(robots, 1.0);
  frame.y_m.assign(robots, 2.0);
  frame.cos_h.assign(robots, 1.0);
  frame.sin_h.assign(robots, 0.0);
  return frame;
}

/// The next text of this type; an empty object: none came.
Json next_text(Client& client, const std::string& type) {
  const auto end = std::chrono::steady_clock::now() + 60s;
  while (std::chrono::steady_clock::now() < end) {
    const auto received = client.receive(1000ms);
    if (!received) continue;
    if (received->kind == Client::Received::Kind::Close) break;
    if (received->kind != Client::Received::Kind::Text) continue;
    Json json = hal::parse_json(received->bytes).value();
    if (json["type"] == type) return json;
  }
  return {};
}

/// With which code the connection ends.
int closed_with(Client& client) {
  const auto end = std::chrono::steady_clock::now() + 60s;
  while (std::chrono::steady_clock::now() < end) {
    const auto received = client.receive(1000ms);
    if (received && received->kind == Client::Received::Kind::Close) return received->code;
  }
  return 0;
}

HttpAnswer get(const Window& window, const std::string& target, const std::string& more = "",
               const std::string& host = "localhost") {
  auto answer = ask("127.0.0.1", window.port(),
                    "GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n" + more + "Connection: close\r\n\r\n");
  EXPECT_TRUE(answer.ok()) << (answer.ok() ? "" : answer.error().message);
  return answer.ok() ? answer.value() : HttpAnswer{};
}

std::string token_of(const Window& window) {
  return window.address().substr(window.address().find("token=") + 6);
}

TEST(Window, ServesThePageAndWhatIsOfTheRunToWhoKnowsTheTokenAlone) {
  const auto window = open_window();
  EXPECT_TRUE(window->address().starts_with("http://127.0.0.1:" + std::to_string(window->port()) + "/?token="));
  const HttpAnswer page = get(*window, "/?token=" + token_of(*window));
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.head.find("text/html"), std::string::npos);
  EXPECT_NE(page.head.find("Content-Security-Policy: default-src 'self'"), std::string::npos);
  EXPECT_NE(page.body.find("<html"), std::string::npos);
  EXPECT_EQ(get(*window, "/").status, 200);  // holds nothing of the run
  EXPECT_EQ(get(*window, "/ws?token=" + std::string(32, '0')).status, 403);
  EXPECT_EQ(get(*window, "/ws?token=" + token_of(*window)).status, 426);
  EXPECT_EQ(get(*window, "/floor.png").status, 403);
  EXPECT_EQ(get(*window, "/picture.svg").status, 403);
  EXPECT_EQ(get(*window, "/ws").status, 403);
  EXPECT_EQ(get(*window, "/nothing?token=" + token_of(*window)).status, 404);
  EXPECT_EQ(get(*window, "/floor.png?token=" + token_of(*window)).status, 404);
  EXPECT_EQ(get(*window, "/../../etc/passwd?token=" + token_of(*window)).status, 404);
}

TEST(Window, ServesModulesPackedAndOnce) {
  const auto window = open_window();
  const HttpAnswer plain = get(*window, "/three.module.js");
  EXPECT_EQ(plain.status, 200);
  EXPECT_NE(plain.head.find("text/javascript"), std::string::npos);
  EXPECT_GT(plain.body.size(), 500'000U);
  const HttpAnswer packed = get(*window, "/three.module.js", "Accept-Encoding: gzip, br\r\n");
  EXPECT_NE(packed.head.find("Content-Encoding: gzip"), std::string::npos);
  EXPECT_LT(packed.body.size(), 400'000U);
  const std::size_t at = packed.head.find("ETag: ");
  ASSERT_NE(at, std::string::npos);
  const std::string tag = packed.head.substr(at + 6, packed.head.find('\r', at) - at - 6);
  EXPECT_EQ(get(*window, "/three.module.js", "If-None-Match: " + tag + "\r\n").status, 304);
}

TEST(Window, RefusesNamesAndPagesOfOthers) {
  const auto window = open_window();
  const std::string target = "/?token=" + token_of(*window);
  EXPECT_EQ(get(*window, target, "", "evil.example").status, 403);
  EXPECT_EQ(get(*window, target, "Origin: http://evil.example\r\n").status, 403);
  EXPECT_EQ(get(*window, target, "Origin: http://localhost\r\n").status, 200);
  EXPECT_FALSE(Client::connect(window->address(), {"Origin: http://evil.example"}).ok());
  EXPECT_TRUE(Client::connect(window->address(), {"Origin: http://127.0.0.1:" + std::to_string(window->port())}).ok());
  std::string wrong = window->address();
  wrong.back() = wrong.back() == '0' ? '1' : '0';
  EXPECT_FALSE(Client::connect(wrong).ok());
}

TEST(Window, SaysWhenAPortIsTakenOrAnAddressIsNone) {
  const auto window = open_window();
  WindowOptions options;
  options.port = window->port();
  const auto second = Window::open(options);
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.error().message.find("another program has this port"), std::string::npos) << second.error().message;
  options.address = "nowhere";
  EXPECT_NE(Window::open(options).error().message.find("no address in numbers"), std::string::npos);
  options.address = "192.0.2.1";
  EXPECT_NE(Window::open(options).error().message.find("does not have this address"), std::string::npos);
}

TEST(Window, WantsFramesOnlyWhileSomebodyWatches) {
  const auto window = open_window();
  EXPECT_FALSE(window->wants_frame());
  EXPECT_FALSE(window->watched());
  {
    Client client = join(*window);
    EXPECT_TRUE(eventually([&] { return window->watched(); }, kPatience_s));
    window->show(frame_of(3));
    EXPECT_TRUE(eventually([&] { return window->wants_frame(); }, kPatience_s));
  }
  EXPECT_TRUE(eventually([&] { return !window->watched() && !window->wants_frame(); }, kPatience_s));
}

TEST(Window, AViewerGetsTheFrameThatIsShownAndWhatWasTold) {
  const auto window = open_window();
  window->tell({{"type", "hello"}, {"protocol", 2}, {"layers", Json::array()}});
  window->tell({{"type", "state"}, {"tick", 5}});
  window->tell({{"type", "log"}, {"entries", {{{"n", 1}, {"text", "one"}}}}});
  window->tell({{"type", "log"}, {"entries", {{{"n", 2}, {"text", "two"}}}}});
  window->show(frame_of(3, 5));
  Client client = join(*window);
  EXPECT_EQ(next_text(client, "hello")["protocol"], 2);
  bool state = false, log = false, frame = false;
  EXPECT_TRUE(eventually(
      [&] {
        const auto received = client.receive(100ms);
        if (!received) return false;
        if (received->kind == Client::Received::Kind::Binary) {
          frame = true;
          EXPECT_EQ(received->bytes.size(), 32U + 3U * 16U);
        } else {
          const Json json = hal::parse_json(received->bytes).value();
          state = state || (json["type"] == "state" && json["tick"] == 5 && json["viewers"] == 1);
          log = log || (json["type"] == "log" && json["entries"].size() == 2);
        }
        return state && log && frame;
      },
      kPatience_s));
}

TEST(Window, TellsTheStateTwiceASecond) {
  const auto window = open_window();
  window->tell({{"type", "state"}, {"tick", 5}});
  Client client = join(*window);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(next_text(client, "state")["tick"], 5);
}

TEST(Window, CommandsAreAnsweredToWhoAsked) {
  const auto window = open_window();
  std::vector<WindowReply> later;
  window->set_commands([&](Json command, WindowReply reply) {
    if (command["do"] == "later") return later.push_back(std::move(reply));
    reply({{"ok", true}, {"did", command["do"]}, {"had_id", command.contains("id")}});
  });
  Client one = join(*window), other = join(*window);
  ASSERT_TRUE(one.send(R"({"id":1,"do":"later"})").ok());
  ASSERT_TRUE(other.send(R"({"id":"x","do":"pause"})").ok());
  const Json answer = next_text(other, "answer");
  EXPECT_EQ(answer["id"], "x");
  EXPECT_EQ(answer["did"], "pause");
  EXPECT_EQ(answer["had_id"], false);
  ASSERT_TRUE(one.send(R"({"id":2,"do":"play"})").ok());
  EXPECT_EQ(next_text(one, "answer")["id"], 2);
  ASSERT_EQ(later.size(), 1U);
  std::thread([&] { later[0]({{"ok", false}, {"error", "no"}}); }).join();
  const Json late = next_text(one, "answer");
  EXPECT_EQ(late["id"], 1);
  EXPECT_EQ(late["error"], "no");
}

TEST(Window, AnswersToWhoIsGoneGoNowhere) {
  std::vector<WindowReply> later;
  {
    const auto window = open_window();
    std::atomic<int> taken{0};
    window->set_commands([&](Json, WindowReply reply) {
      later.push_back(std::move(reply));
      ++taken;
    });
    {
      Client client = join(*window);
      ASSERT_TRUE(client.send(R"({"id":1,"do":"play"})").ok());
      ASSERT_TRUE(eventually([&] { return taken == 1; }, kPatience_s));
    }
    EXPECT_TRUE(eventually([&] { return !window->watched(); }, kPatience_s));
    later[0]({{"ok", true}});
  }
  later[0]({{"ok", true}});
}

TEST(Window, KnowsWhatViewersWish) {
  const auto window = open_window();
  std::atomic<int> wished{0};
  window->on_wish([&] { ++wished; });
  window->tell({{"type", "hello"}, {"layers", {{{"name", "rays"}}, {{"name", "ids"}}}}});
  Client one = join(*window), two = join(*window);
  ASSERT_TRUE(one.send(R"({"id":1,"do":"layers","on":["rays"],"robots":["a"]})").ok());
  ASSERT_TRUE(two.send(R"({"id":1,"do":"layers","on":["ids"],"robots":["b","a"]})").ok());
  ASSERT_TRUE(two.send(R"({"id":2,"do":"inspect","robots":["c"]})").ok());
  EXPECT_TRUE(eventually([&] { return window->wishes().inspected.size() == 1 && window->wishes().layers.size() == 2; },
                         kPatience_s));
  const Wishes wishes = window->wishes();
  EXPECT_EQ(wishes.layers, (std::vector<std::string>{"ids", "rays"}));
  EXPECT_EQ(wishes.layer_robots, (std::vector<std::string>{"a", "b"}));
  EXPECT_FALSE(wishes.all_robots);
  EXPECT_GE(wished, 2);
  ASSERT_TRUE(one.send(R"({"id":2,"do":"layers","on":["nonsense"]})").ok());
  Json answer = next_text(one, "answer");
  answer = next_text(one, "answer");
  EXPECT_EQ(answer["error"], "there is no layer 'nonsense'; there are: rays, ids");
  window->tell({{"type", "inspection"}, {"tick", 1}, {"robots", {{{"id", "c"}}, {{"id", "d"}}}}});
  const Json inspection = next_text(two, "inspection");
  ASSERT_EQ(inspection["robots"].size(), 1U);
  EXPECT_EQ(inspection["robots"][0]["id"], "c");
}

TEST(Window, HostileTextsAreClosedWithTheCodeThatFits) {
  const auto window = open_window();
  const auto code_of = [&](const std::function<void(Client&)>& act) {
    Client client = join(*window);
    act(client);
    return closed_with(client);
  };
  EXPECT_EQ(code_of([](Client& c) { (void)c.send("nonsense"); }), 1007);
  EXPECT_EQ(code_of([](Client& c) { (void)c.send(std::string(30000, '[')); }), 1007);
  EXPECT_EQ(code_of([](Client& c) { (void)c.send_frame(0x82, "bytes"); }), 1003);
  EXPECT_EQ(code_of([](Client& c) { (void)c.send("{\"do\":\"" + std::string(70'000, 'x') + "\"}"); }), 1009);
  EXPECT_EQ(code_of([](Client& c) { (void)c.send_frame(0x81, "{\"do\":\"\xff\xfe\"}"); }), 1007);
  EXPECT_EQ(code_of([](Client& c) { (void)c.send_frame(0x81, "{}", false); }), 1002);  // not masked
  EXPECT_EQ(code_of([](Client& c) { (void)c.send_frame(0xF1, "{}"); }), 1002);         // reserved bits
  EXPECT_EQ(code_of([](Client& c) { (void)c.send_frame(0x8B, "{}"); }), 1002);         // an opcode that is none
  EXPECT_EQ(code_of([](Client& c) { (void)c.send_frame(0x80, "{}"); }), 1002);         // goes on with nothing
  EXPECT_EQ(code_of([](Client& c) {
              for (int i = 0; i < 201; ++i) (void)c.send(R"({"id":1,"do":"rate","frames_per_s":20})");
            }),
            1008);
  EXPECT_EQ(code_of([](Client& c) { (void)c.send_frame(0x88, std::string("\x03\xe8", 2)); }), 1000);
  Client good = join(*window);  // the window is well
  ASSERT_TRUE(good.send(R"({"id":1,"do":"rate","frames_per_s":5})").ok());
  EXPECT_EQ(next_text(good, "answer")["ok"], true);
}

TEST(Window, FragmentsOfATextAreOneText) {
  const auto window = open_window();
  Client client = join(*window);
  ASSERT_TRUE(client.send_frame(0x01, R"({"id":9,"do":"rate",)").ok());
  ASSERT_TRUE(client.send_frame(0x80, R"("frames_per_s":5})").ok());
  EXPECT_EQ(next_text(client, "answer")["id"], 9);
}

TEST(Window, RequestsThatAreNoneEndTheirConnection) {
  const auto window = open_window();
  for (const std::string& request :
       {std::string("\x16\x03\x01\x02"), std::string(20'000, 'A'), std::string("GET / HTTP/9.9\r\n\r\n"),
        std::string("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\n\r\nhello")}) {
    const auto answer = ask("127.0.0.1", window->port(), request + "\r\n\r\n");
    EXPECT_TRUE(!answer.ok() || answer.value().status >= 400);
  }
  EXPECT_EQ(get(*window, "/?token=" + token_of(*window)).status, 200);
}

TEST(Window, AHundredViewersAndOneThatNeverReadsStopNobody) {
  const auto window = open_window();
  std::vector<Client> viewers;
  for (int i = 0; i < 100; ++i) viewers.push_back(join(*window));
  Client deaf = join(*window);
  ASSERT_TRUE(eventually([&] { return window->viewers() == 101; }, kPatience_s));
  std::atomic<bool> over{false};
  std::thread stepping([&] {
    for (hal::Tick tick = 1; !over; ++tick) {
      window->show(frame_of(5000, tick));
      std::this_thread::sleep_for(5ms);
    }
  });
  for (Client& viewer : viewers) {
    int frames = 0;
    EXPECT_TRUE(eventually(
        [&] {
          const auto received = viewer.receive(200ms);
          frames += received && received->kind == Client::Received::Kind::Binary ? 1 : 0;
          return frames >= 3;
        },
        kPatience_s));
  }
  EXPECT_TRUE(
      eventually([&] { return window->viewers() == 0; }, kPatience_s));  // nobody reads any more: all are let go
  over = true;
  stepping.join();
}

TEST(Window, WhoAcknowledgesGetsNoStaleFrames) {
  const auto window = open_window();
  Client client = join(*window);
  ASSERT_TRUE(client.send(R"({"do":"got","frame":0})").ok());
  ASSERT_TRUE(client.send(R"({"id":1,"do":"rate","frames_per_s":60})").ok());
  ASSERT_EQ(next_text(client, "answer")["ok"], true);
  int frames = 0;
  for (hal::Tick tick = 1; tick <= 30; ++tick) {
    window->show(frame_of(3, tick));
    std::this_thread::sleep_for(20ms);
  }
  while (const auto received = client.receive(300ms))
    frames += received->kind == Client::Received::Kind::Binary ? 1 : 0;
  EXPECT_EQ(frames, 2);
  ASSERT_TRUE(client.send(R"({"do":"got","frame":2})").ok());
  std::optional<Client::Received> next;
  ASSERT_TRUE(eventually(
      [&] {
        next = client.receive(500ms);
        return next && next->kind == Client::Received::Kind::Binary;
      },
      kPatience_s));
  std::int64_t tick = 0;
  std::memcpy(&tick, next->bytes.data() + 8, sizeof tick);
  EXPECT_EQ(tick, 30);
}

TEST(Window, PicturesAreMadeWhenTheyAreAskedFor) {
  const auto window = open_window();
  window->set_pictures([](const std::string& name, WindowFileReply reply) {
    if (name == "picture.svg") return reply({"<svg/>", "image/svg+xml", ""});
    reply({"", "", "no renderer"});
  });
  const HttpAnswer svg = get(*window, "/picture.svg?token=" + token_of(*window));
  EXPECT_EQ(svg.status, 200);
  EXPECT_EQ(svg.body, "<svg/>");
  const HttpAnswer png = get(*window, "/picture.png?token=" + token_of(*window));
  EXPECT_EQ(png.status, 500);
  EXPECT_EQ(png.body, "no renderer\n");
}

TEST(Window, MoreViewersThanAllowedAreTurnedAway) {
  WindowOptions options;
  options.most_viewers = 2;
  const auto window = open_window(options);
  Client one = join(*window), two = join(*window);
  ASSERT_TRUE(eventually([&] { return window->viewers() == 2; }, kPatience_s));
  const auto third = Client::connect(window->address());
  ASSERT_FALSE(third.ok());
  EXPECT_NE(third.error().message.find("503"), std::string::npos);
}

/// Connections that send what begins a request, and never end it: whatever is closed comes again.
class HalfOpen {
 public:
  /// From 127.0.0.1 to 127.0.0.`addresses`, in turn.
  HalfOpen(std::uint16_t port, int count, int addresses) : port_(port), addresses_(addresses) {
    sockets_.resize(static_cast<std::size_t>(count), -1);
    renew();
  }
  ~HalfOpen() {
    for (const int socket : sockets_) ::close(socket);
  }
  HalfOpen(const HalfOpen&) = delete;
  HalfOpen& operator=(const HalfOpen&) = delete;

  void renew() {
    for (std::size_t i = 0; i < sockets_.size(); ++i) {
      if (sockets_[i] >= 0 && is_open(sockets_[i])) continue;
      if (sockets_[i] >= 0) ::close(sockets_[i]);
      sockets_[i] = open(static_cast<int>(i) % addresses_ + 1);
    }
  }

  std::ptrdiff_t closed() const {
    return std::count_if(sockets_.begin(), sockets_.end(), [](int socket) { return !is_open(socket); });
  }

 private:
  static bool is_open(int socket) {
    char byte = 0;
    return ::recv(socket, &byte, 1, MSG_DONTWAIT) < 0 && errno == EAGAIN;
  }
  int open(int host) const {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in from{}, to{};
    from.sin_family = to.sin_family = AF_INET;
    from.sin_addr.s_addr = htonl(0x7F000000U + static_cast<std::uint32_t>(host));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons(port_);
    EXPECT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&from), sizeof from), 0);
    EXPECT_EQ(::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    EXPECT_EQ(::send(socket, "GET / HTTP/1.1\r\nHo", 18, MSG_NOSIGNAL), 18);
    return socket;
  }

  std::uint16_t port_;
  int addresses_;
  std::vector<int> sockets_;
};

void expect_the_operator_gets_in(int addresses) {
  const auto window = open_window();
  std::atomic<int> stops{0};
  window->set_commands([&](const Json& command, const WindowReply& reply) {
    stops += command["do"] == "estop" ? 1 : 0;
    reply({{"ok", true}});
  });
  HalfOpen crowd(window->port(), 400, addresses);
  constexpr int kTries = 30;
  for (int i = 0; i < kTries; ++i) {
    crowd.renew();
    auto client = Client::connect(window->address());
    ASSERT_TRUE(client.ok()) << "try " << i << ": " << client.error().message;
    ASSERT_TRUE(client.value().send(R"({"id":1,"do":"estop"})").ok());
    ASSERT_EQ(next_text(client.value(), "answer")["ok"], true);
    EXPECT_EQ(get(*window, "/?token=" + token_of(*window)).status, 200);
  }
  EXPECT_EQ(stops, kTries);
}

TEST(Window, HalfOpenConnectionsOfOneAddressKeepNobodyFromTheEmergencyStop) {
  expect_the_operator_gets_in(1);
}

TEST(Window, HalfOpenConnectionsOfManyAddressesKeepNobodyFromTheEmergencyStop) {
  expect_the_operator_gets_in(200);
}

TEST(Window, AConnectionOverWhichATokenWasShownIsNotDroppedForOthers) {
  const auto window = open_window();
  const auto heard = [](int socket, const std::string& request) {
    char answer[1000] = {};
    (void)::send(socket, request.data(), request.size(), MSG_NOSIGNAL);
    const ssize_t n = ::recv(socket, answer, sizeof answer, 0);
    return n > 0 ? std::string(answer, static_cast<std::size_t>(n)) : "closed";
  };
  const std::string request = "GET /favicon.ico?token=" + token_of(*window) + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  to.sin_port = htons(window->port());
  for (bool in_time = false; !in_time;) {  // a connection over which nothing is said for 5 s may end
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    ASSERT_EQ(::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
    ASSERT_EQ(heard(socket, request).substr(0, 12), "HTTP/1.1 204");
    const auto said = std::chrono::steady_clock::now();
    const HalfOpen crowd(window->port(), 100, 1);
    ASSERT_TRUE(eventually([&] { return crowd.closed() > 20; }, kPatience_s)) << "some had to make room";
    const std::string answer = heard(socket, request);
    in_time = std::chrono::steady_clock::now() - said < std::chrono::seconds(4);
    if (in_time) {
      EXPECT_EQ(answer.substr(0, 12), "HTTP/1.1 204");
    }
    ::close(socket);
  }
}

TEST(Window, AConnectionThatNeverEndsItsRequestIsLetGo) {
  const auto window = open_window();
  const auto began = std::chrono::steady_clock::now();
  const auto answer = ask("127.0.0.1", window->port(), "GET / HTTP/1.1\r\nHo");
  EXPECT_FALSE(answer.ok());
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(25)) << "a client waits for 30 s";
  EXPECT_NE(answer.error().message.find("no answer of HTTP"), std::string::npos) << answer.error().message;
}

Client join_as_viewer(const Window& window) {
  auto client = Client::connect(window.viewers_address());
  EXPECT_TRUE(client.ok()) << (client.ok() ? "" : client.error().message);
  return std::move(client).value();
}

TEST(Window, AViewerSeesAndMayStopAndCommandsNothingElse) {
  const auto window = open_window();
  EXPECT_NE(window->address(), window->viewers_address());
  std::vector<Json> taken;
  window->set_commands([&](const Json& command, const WindowReply& reply) {
    taken.push_back(command);
    reply({{"ok", true}});
  });
  window->tell({{"type", "hello"}, {"layers", {{{"name", "rays"}}}}});
  window->show(frame_of(3));
  Client viewer = join_as_viewer(*window), operating = join(*window);
  EXPECT_EQ(next_text(viewer, "role")["role"], "viewer");
  const Json role = next_text(operating, "role");
  EXPECT_EQ(role["role"], "operator");
  EXPECT_TRUE(window->viewers_address().ends_with("token=" + role["look_on"].get<std::string>()));
  int id = 0;
  const auto say = [&](Client& who, Json command) {
    command["id"] = ++id;
    EXPECT_TRUE(who.send(hal::to_text(command)).ok());
    return next_text(who, "answer");
  };
  for (const char* name : {"pause", "play", "arm", "rearm", "replace", "first_motion", "move", "set", "projector",
                           "history", "nonsense", "reload"}) {
    const Json answer = say(viewer, {{"do", name}});
    EXPECT_EQ(answer["ok"], false) << name;
    EXPECT_NE(answer["error"].get<std::string>().find("needs the address of an operator"), std::string::npos) << name;
  }
  EXPECT_TRUE(taken.empty());
  EXPECT_EQ(say(viewer, {{"do", "layers"}, {"on", {"rays"}}})["ok"], true);
  EXPECT_EQ(say(viewer, {{"do", "rate"}, {"frames_per_s", 5}})["ok"], true);
  EXPECT_EQ(say(viewer, {{"do", "estop"}, {"who", "ben"}, {"by", {{"role", "operator"}}}})["ok"], true);
  EXPECT_EQ(say(operating, {{"do", "arm"}, {"by", "nobody"}})["ok"], true);
  ASSERT_EQ(taken.size(), 2U);
  EXPECT_EQ(taken[0]["by"], (Json{{"role", "viewer"}, {"address", "127.0.0.1"}})) << "the window's word, not theirs";
  EXPECT_EQ(taken[0]["who"], "ben");
  EXPECT_EQ(taken[1]["by"], (Json{{"role", "operator"}, {"address", "127.0.0.1"}}));
}

TEST(Window, NothingThatAViewerIsSentHoldsTheTokenOfAnOperator) {
  const auto window = open_window();
  Frame frame = frame_of(3);
  auto scene = std::make_shared<FrameScene>();
  scene->number = 1;
  scene->json = Json::object();
  scene->floor = std::make_shared<const core::FloorImage>(core::FloorImage{2, 2, {0, 1, 2, 3}});
  frame.scene = scene;
  window->show(std::move(frame));
  Client viewer = join_as_viewer(*window);
  const Json told = next_text(viewer, "scene");
  const auto floor = told["floor"].get<std::string>();
  EXPECT_EQ(floor.find(token_of(*window)), std::string::npos);
  EXPECT_EQ(get(*window, floor).status, 200) << floor;
}

TEST(Window, ViewersLeavePlacesForOperators) {
  WindowOptions options;
  options.most_viewers = 8;
  const auto window = open_window(options);
  std::vector<Client> viewers;
  for (int i = 0; i < 4; ++i) viewers.push_back(join_as_viewer(*window));
  EXPECT_FALSE(Client::connect(window->viewers_address()).ok());
  for (int i = 0; i < 4; ++i) viewers.push_back(join(*window));
  EXPECT_FALSE(Client::connect(window->address()).ok());
}

TEST(Window, ViewersWhoAskAllTheTimeKeepNobodyFromAStop) {
  const auto window = open_window();
  std::atomic<int> asked{0}, stops{0};
  window->set_commands([&](const Json& command, const WindowReply& reply) {
    (command["do"] == "estop" ? stops : asked) += 1;
    reply({{"ok", true}});
  });
  Client loud = join_as_viewer(*window), other = join_as_viewer(*window);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(loud.send(R"({"id":1,"do":"status"})").ok());
  ASSERT_TRUE(eventually([&] { return next_text(loud, "answer")["ok"] == false; }, kPatience_s));
  ASSERT_TRUE(other.send(R"({"id":1,"do":"estop"})").ok());
  EXPECT_EQ(next_text(other, "answer")["ok"], true);
  EXPECT_EQ(stops, 1);
  EXPECT_LT(asked, 100);
}

TEST(Window, TwoNamesInARequestAreRefused) {
  const auto window = open_window();
  const std::string target = "/?token=" + token_of(*window);
  EXPECT_EQ(get(*window, target, "Host: evil.example\r\n").status, 400);
  EXPECT_EQ(get(*window, target, "Host: localhost\r\n").status, 400);
  EXPECT_EQ(get(*window, target, "Origin: http://localhost\r\nOrigin: http://evil.example\r\n").status, 400);
}

TEST(Window, SaysFarewellToItsViewers) {
  auto window = open_window();
  Client client = join(*window);
  ASSERT_TRUE(eventually([&] { return window->watched(); }, kPatience_s));
  std::thread reading([&] { EXPECT_EQ(closed_with(client), 1001); });
  window.reset();
  reading.join();
}

}  // namespace
}  // namespace tandem::window
