#include "bridges/aseba/stream_messages.hpp"

#include "bridges/aseba/message.hpp"

namespace tandem::bridges::aseba {
namespace {

/// Types whose payload is nothing but words.
bool only_words(std::uint16_t type) noexcept {
  switch (static_cast<Type>(type)) {
    case Type::Description:
    case Type::NamedVariable:
    case Type::LocalEvent:
    case Type::NativeFunction:
    case Type::NodeError:
      return false;
    default:
      return true;
  }
}

}  // namespace

bool StreamReader::take(std::span<const std::uint8_t>& bytes, hal::TimeNs at) noexcept {
  while (!bytes.empty() && stepping_ == Stepping::InStep) {
    const std::size_t wanted = size_ < kStreamHeader ? kStreamHeader : kStreamHeader + read_u16(bytes_.data());
    const std::size_t n = std::min(wanted - size_, bytes.size());
    std::copy_n(bytes.begin(), n, bytes_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += n;
    bytes = bytes.subspan(n);
    if (size_ < kStreamHeader) break;
    const std::size_t length = read_u16(bytes_.data());
    const std::uint16_t type = read_u16(bytes_.data() + 4);
    if (length > kMostPayload) {
      stepping_ = Stepping::TooLong;
    } else if (length % 2 != 0 && only_words(type)) {
      stepping_ = Stepping::HalfWord;
    } else if (size_ == kStreamHeader + length) {
      message_ = {read_u16(bytes_.data() + 2), type, std::span(bytes_).subspan(kStreamHeader, length), at};
      size_ = 0;
      return true;
    }
  }
  return false;
}

StreamMessages::StreamMessages(std::unique_ptr<ByteLink> link, const StreamSettings& settings, Clock clock)
    : link_(std::move(link)), settings_(settings), clock_(std::move(clock)) {}

void StreamMessages::gone() noexcept {
  if (state_ == Carrier::Gone) return;
  state_ = Carrier::Gone;
  ++statistics_.times_down;
  statistics_.dropped += queued_;
  queued_ = 0;
  out_size_ = 0;
}

void StreamMessages::flush(hal::TimeNs now) noexcept {
  if (state_ != Carrier::Up) return;
  if (queued_ > 0 && now - queue_[0].since_ns > settings_.send_timeout_ns) {
    ++statistics_.times_stuck;
    if (queue_[0].begun) return gone();
    statistics_.dropped += queued_;
    queued_ = 0;
    out_size_ = 0;
  }
  if (out_size_ == 0) return;
  std::size_t done = link_->write(std::span(out_).first(out_size_), 0);
  std::copy(out_.begin() + static_cast<std::ptrdiff_t>(done), out_.begin() + static_cast<std::ptrdiff_t>(out_size_),
            out_.begin());
  out_size_ -= done;
  std::size_t complete = 0;
  while (complete < queued_ && queue_[complete].left <= done) done -= queue_[complete++].left;
  statistics_.sent += complete;
  std::copy(queue_.begin() + static_cast<std::ptrdiff_t>(complete),
            queue_.begin() + static_cast<std::ptrdiff_t>(queued_), queue_.begin());
  queued_ -= complete;
  if (queued_ > 0 && done > 0) {
    queue_[0].left -= done;
    queue_[0].begun = true;
  }
  if (link_->state() != LinkState::Open) gone();
}

void StreamMessages::clear() noexcept {
  const std::size_t keep = queued_ > 0 && queue_[0].begun ? 1 : 0;
  statistics_.dropped += queued_ - keep;
  queued_ = keep;
  out_size_ = keep > 0 ? queue_[0].left : 0;
  flush(clock_());
}

bool StreamMessages::send(std::uint16_t type, std::span<const std::uint8_t> payload) noexcept {
  const hal::TimeNs now = clock_();
  flush(now);
  if (state_ != Carrier::Up || payload.size() > kMostPayload) {
    ++statistics_.refused;
    return false;
  }
  const std::size_t size = kStreamHeader + payload.size();
  if (out_size_ + size > kCapacity || queued_ == kMostQueued) {
    ++statistics_.no_room;
    return false;
  }
  std::uint8_t* to = out_.data() + out_size_;
  write_u16(to, static_cast<std::uint16_t>(payload.size()));
  write_u16(to + 2, settings_.source);
  write_u16(to + 4, type);
  std::copy(payload.begin(), payload.end(), to + kStreamHeader);
  out_size_ += size;
  queue_[queued_++] = {size, false, now};
  flush(now);
  return state_ == Carrier::Up;
}

bool StreamMessages::receive(MessageView& message) noexcept {
  const hal::TimeNs now = clock_();
  flush(now);
  while (state_ == Carrier::Up) {
    if (reader_.take(unread_, arrived_ns_)) {
      ++statistics_.received;
      message = reader_.message();
      return true;
    }
    if (reader_.stepping() != Stepping::InStep) {
      ++statistics_.broken_in;
      gone();
      break;
    }
    const Received received = link_->read(in_);
    if (received.size == 0) {
      if (link_->state() != LinkState::Open) gone();
      break;
    }
    unread_ = std::span(in_).first(received.size);
    arrived_ns_ = received.at_ns;
  }
  if (state_ == Carrier::Up && reader_.in_message() && now - arrived_ns_ > settings_.message_timeout_ns) {
    ++statistics_.broken_in;
    gone();
  }
  return false;
}

bool StreamMessages::wait(hal::TimeNs timeout_ns) noexcept {
  flush(clock_());
  if (!unread_.empty()) return true;
  const bool ready = link_->wait(out_size_ > 0 ? std::min(timeout_ns, hal::kNsPerMs) : timeout_ns);
  flush(clock_());
  return ready;
}

}  // namespace tandem::bridges::aseba
