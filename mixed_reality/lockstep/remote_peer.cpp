#include "mixed_reality/lockstep/remote_peer.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "core/space/stores.hpp"

namespace tandem::mixed_reality {
namespace {

namespace peer = bridges::peer;
using peer::MessageType;

constexpr hal::TimeNs kOpenAgain_ns = 200 * hal::kNsPerMs;
constexpr hal::TimeNs kWriteWithin_ns = 200 * hal::kNsPerMs;

std::string list_of(const std::vector<peer::PortName>& ports) {
  std::string text;
  for (const peer::PortName& port : ports) text += (text.empty() ? "" : ", ") + peer::name_of(port);
  return text.empty() ? "none" : text;
}

}  // namespace

RemotePeer::RemotePeer(core::World& world, core::RobotId robot, std::string session, bridges::LinkOpener open,
                       const hal::Log& log)
    : robot_(robot), open_(std::move(open)), log_(log), any_controller_(world.scenario().lockstep.any_controller) {
  core::Space& space = world.space();
  const core::SpaceStores& stores = space.stores();
  const core::RobotGroup& group = stores.groups[stores.blocks[stores.robots[robot.index].block].group];
  told_.session = std::move(session);
  told_.robot = space.robot_name(robot);
  told_.kind = space.kind(robot).name;
  told_.experiment = world.scenario().name;
  told_.ticks_per_second = world.ticks_per_second();
  told_.seed = world.seed();
  for (const hal::PortType* type : space.ports(robot)) {
    peer::RowForm form(*type);
    peer::PortName name{type->role, std::string(type->name), form.digest()};
    told_.ports.push_back(name);
    told_.fields.push_back(form.fields());
    ports_.push_back({type, std::move(name), std::move(form), space.port(robot, *type)});
  }
  for (const hal::PublishedField& field : group.published) {
    told_.publishes.push_back(peer::form_of(field));
    shown_.push_back(field);
  }
  controller_ = stores.controller_of(robot);
  counts_.robot = told_.robot;
}

void RemotePeer::send(MessageType type, std::span<const std::uint8_t> payload) {
  if (!has_link()) return;
  const auto frame = peer::frame_of(type, payload);
  counts_.bytes_out += link_->write(frame, kWriteWithin_ns);
}

// --- finding each other ---

void RemotePeer::open_link(hal::TimeNs now) {
  if (!open_ || now < next_open_ns_) return;
  next_open_ns_ = now + kOpenAgain_ns;
  auto opened = open_();
  if (!opened.ok()) {
    open_error_ = opened.error().message;
    return;
  }
  open_error_.clear();
  link_ = std::move(opened).value();
  reader_.clear();
  greeted_ = false;
  ++counts_.links;
  counts_.link = link_->name();
}

hal::Status RemotePeer::judge(const peer::Hello& hello) const {
  const std::string who = "robot '" + told_.robot + "'";
  if (hello.version != peer::kVersion)
    return hal::Error{"the peer speaks version " + std::to_string(hello.version) + " of the protocol, this hub " +
                      std::to_string(peer::kVersion)};
  if (!hello.robot.empty() && hello.robot != told_.robot)
    return hal::Error{"the peer is for robot '" + hello.robot + "', and this link is that of " + who};
  const bool same = hello.session == told_.session;
  if (!hello.session.empty() && !same && hello.answered >= 0)
    return hal::Error{who + ": the peer is in the middle of another run"};
  if (!begun_) return {};
  if (!same)
    return hal::Error{who + " is at tick " + std::to_string(asked_) +
                      ": a controller that begins now does not know what was before; begin the run anew"};
  if (hello.answered != asked_ && hello.answered != answered_)
    return hal::Error{who + ": the peer is at tick " + std::to_string(hello.answered) + ", the hub at " +
                      std::to_string(asked_)};
  return {};
}

void RemotePeer::take_over(std::unique_ptr<bridges::ByteLink> link, hal::TimeNs now) {
  link_ = std::move(link);
  reader_.clear();
  greeted_ = false;
  if (!begun_) agreed_ = false;
  left_ = false;
  refused_.clear();
  ++counts_.links;
  counts_.link = link_->name();
  say_robot(now);
}

void RemotePeer::say_robot(hal::TimeNs now) {
  told_.tick = asked_ + 1;
  said_ns_ = now;
  send(MessageType::Robot, peer::bytes_of(told_));
}

void RemotePeer::take_hello(const peer::Hello& hello, hal::TimeNs now) {
  if (const hal::Status good = judge(hello); !good.ok()) return refuse(good.error().message);
  greeted_ = false;
  if (!begun_) agreed_ = false;
  left_ = false;
  refused_.clear();
  say_robot(now);
}

void RemotePeer::refuse(const std::string& why) {
  if (why != refused_) log_.warning("peer of robot '" + told_.robot + "' is refused: " + why);
  refused_ = why;
  greeted_ = false;
  send(MessageType::End, peer::bytes_of(peer::Farewell{true, why}));
}

void RemotePeer::take_ready(std::span<const std::uint8_t> payload) {
  const auto ready = peer::read_ready(payload);
  if (!ready.ok()) return refuse(ready.error().message);
  if (ready.value().session != told_.session) {
    ++counts_.not_understood;
    return;
  }
  if (!agreed_) {
    if (const hal::Status good = agree(ready.value()); !good.ok()) return refuse(good.error().message);
    agreed_ = true;
  }
  const bool again = !std::exchange(greeted_, true);
  if (again && begun_ && answered_ != asked_) send(MessageType::Tick, question_);
}

hal::Status RemotePeer::agree(const peer::Ready& ready) {
  takes_.clear();
  shows_.clear();
  for (const peer::PortName& name : ready.takes) {
    const auto port = std::ranges::find_if(
        ports_, [&](const Port& p) { return p.name.role == name.role && p.name.name == name.name; });
    if (port == ports_.end())
      return hal::Error{"the peer takes the " + peer::name_of(name) +
                        ", which the robot's controller in the hub does not take; there are: " + list_of(told_.ports)};
    if (port->name.digest != name.digest)
      return hal::Error{"the peer's " + peer::name_of(name) + " has another form (" + name.digest +
                        ") than the hub's (" + port->name.digest + "); build both of the same version"};
    for (const Taken& other : takes_) {
      if (other.port == &*port) return hal::Error{"the peer takes the " + peer::name_of(name) + " twice"};
    }
    takes_.push_back({&*port, std::vector<std::max_align_t>(port->type->size / sizeof(std::max_align_t) + 1)});
  }
  for (const peer::PublishedForm& form : ready.publishes) {
    const auto known = std::ranges::find(told_.publishes, form);
    if (known == told_.publishes.end())
      return hal::Error{"the peer publishes '" + form.name +
                        "', which the robot's controller in the hub does not; name the same controller in both files"};
    shows_.push_back(static_cast<std::size_t>(known - told_.publishes.begin()));
  }
  return agree_on_controller(ready);
}

hal::Status RemotePeer::agree_on_controller(const peer::Ready& ready) {
  if (!hubs_copy_) return {};
  const peer::CopyComparison& compared = counts_.controller.emplace(peer::compare(*hubs_copy_, ready.controller));
  if (compared.differs.empty()) return {};
  if (!any_controller_)
    return hal::Error{"another controller: " + compared.differs +
                      "; bring both to one version, or accept that with <peers controllers=\"any\">"};
  log_.warning("peer of robot '" + told_.robot + "' runs another controller: " + compared.differs);
  return {};
}

// --- ticks ---

void RemotePeer::ask(core::World& world, hal::TimeNs now) {
  scratch_.clear();
  for (const Taken& t : takes_) {
    if (t.port->type->role == hal::Role::Actuator) t.port->form.pack(t.port->data, scratch_);
  }
  const bool actuators = !begun_ || scratch_ != commands_;  // limited, made safe, or written by somebody else since
  asked_ = world.tick();
  question_.clear();
  peer::append_tick(question_, asked_, actuators ? peer::kActuatorsFollow : std::uint8_t{0});
  for (const Taken& t : takes_) {
    if (t.port->type->role == hal::Role::Sensor) t.port->form.pack(t.port->data, question_);
  }
  if (actuators) question_.insert(question_.end(), scratch_.begin(), scratch_.end());
  begun_ = true;
  asked_ns_ = said_ns_ = now;
  send(MessageType::Tick, question_);
}

void RemotePeer::take_commands(std::span<const std::uint8_t> payload) {
  const std::span<const std::uint8_t> whole = payload;
  peer::TickHead head;
  if (!peer::take_head(payload, head)) {
    ++counts_.not_understood;
  } else if (head.tick != asked_) {
    const bool before = begun_ && head.tick >= 0 && head.tick < asked_;
    if (!before && counts_.wrong_tick++ == 0) {
      log_.warning("peer of robot '" + told_.robot + "' answered tick " + std::to_string(head.tick) + ", at tick " +
                   std::to_string(asked_) + ": left out");
    }
    if (before) ++counts_.doubled;
  } else if (answered_ == asked_) {
    ++counts_.doubled;
  } else {
    answer_.assign(whole.begin(), whole.end());
    answered_ = asked_;
    ++counts_.ticks;
  }
}

/// Nothing is written unless all of it is good.
hal::Status RemotePeer::write_commands(core::World& world) {
  std::span<const std::uint8_t> in = answer_;
  peer::TickHead head;
  (void)peer::take_head(in, head);
  if ((head.flags & peer::kThrew) != 0) {
    world.controller_threw(robot_, std::string(in.begin(), in.end()));
    return {};
  }
  const std::span<const std::uint8_t> rows = in;
  for (Taken& t : takes_) {
    if (t.port->type->role != hal::Role::Actuator) continue;
    std::memcpy(t.row.data(), t.port->data, t.port->type->size);
    if (!t.port->form.unpack(in, t.row.data()))
      return hal::Error{"its commands are too short, or use more than there is"};
  }
  commands_.assign(rows.begin(), rows.end() - static_cast<std::ptrdiff_t>(in.size()));
  std::size_t left = in.size();
  for (const std::size_t i : shows_) {
    const std::size_t bytes = hal::size_of(shown_[i]);
    if (left < bytes) return hal::Error{"its commands lack what its controller publishes"};
    left -= bytes;
  }
  if (left != 0) return hal::Error{"its commands are longer than was agreed on"};
  for (const Taken& t : takes_) {
    if (t.port->type->role == hal::Role::Actuator) std::memcpy(t.port->data, t.row.data(), t.port->type->size);
  }
  // The controller in the hub stands still, and shows what the peer's publishes.
  for (const std::size_t i : shows_) {
    const hal::PublishedField& field = shown_[i];
    const std::size_t bytes = hal::size_of(field);
    auto* const to = reinterpret_cast<std::uint8_t*>(controller_ + field.offset);
    if (field.scalar == hal::Scalar::Bool) {
      for (std::size_t k = 0; k < bytes; ++k) to[k] = in[k] != 0 ? 1 : 0;
    } else {
      std::memcpy(to, in.data(), bytes);
    }
    in = in.subspan(bytes);
  }
  return {};
}

// --- the link ---

void RemotePeer::pump(hal::TimeNs now) {
  if (!has_link()) open_link(now);
  if (link_ == nullptr) return;
  std::array<std::uint8_t, 4096> buffer;
  for (bridges::Received got = link_->read(buffer); got.size > 0; got = link_->read(buffer)) {
    counts_.bytes_in += got.size;
    reader_.push(std::span(buffer).first(got.size));
  }
  while (const auto frame = reader_.next()) take(*frame, now);
  if (!has_link()) return;
  const bool waits = greeted_ && begun_ && answered_ != asked_;
  if (waits) counts_.longest_wait_ns = std::max(counts_.longest_wait_ns, now - asked_ns_);
  if (!waits || now - said_ns_ < kAskAgain_ns) return;
  said_ns_ = now;
  ++counts_.asked_again;
  send(MessageType::Tick, question_);
}

void RemotePeer::take(const peer::FrameReader::Frame& frame, hal::TimeNs now) {
  if (!refused_.empty() && frame.type != MessageType::Hello) return;
  switch (frame.type) {
    case MessageType::Hello:
      if (const auto hello = peer::read_hello(frame.payload); hello.ok()) return take_hello(hello.value(), now);
      break;
    case MessageType::Ready:
      return take_ready(frame.payload);
    case MessageType::Commands:
      return take_commands(frame.payload);
    case MessageType::Bye: {
      const auto bye = peer::read_farewell(frame.payload);
      left_ = true;
      open_error_ = "it left" + (bye.ok() && !bye.value().text.empty() ? ": " + bye.value().text : "");
      return;
    }
    default:
      break;
  }
  ++counts_.not_understood;
}

std::string RemotePeer::trouble() const {
  if (!refused_.empty()) return "refused: " + refused_;
  if (left_) return open_error_;
  if (link_ == nullptr) return open_error_.empty() ? "nobody has connected" : open_error_;
  if (!has_link()) return "its link " + link_->name() + " is lost" + (open_error_.empty() ? "" : ": " + open_error_);
  if (!greeted_) return "at " + link_->name() + ", has not said what its controller takes";
  return "at " + link_->name() + ", has not answered";
}

void RemotePeer::end(bool error, const std::string& why) {
  if (left_ || !refused_.empty()) return;
  send(MessageType::End, peer::bytes_of(peer::Farewell{error, why}));
}

PartnerReport RemotePeer::report() const {
  PartnerReport report = counts_;
  report.garbled = reader_.garbled();
  report.state = !ready() ? trouble() : answered() ? "in step" : "waited for";
  return report;
}

}  // namespace tandem::mixed_reality
