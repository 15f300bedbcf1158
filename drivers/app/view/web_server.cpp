// SPDX-License-Identifier: BSD-3-Clause
#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <plica/core/error.hpp>
#include <plica/drivers/app/view/web_server.hpp>
#include <string_view>

namespace plica::app {
namespace {

constexpr std::size_t longest_head = 16384, longest_body = 65536;  // bytes
constexpr std::chrono::seconds between_signs_of_life(1);

bool send_all(int socket, std::string_view text) {
  while (!text.empty()) {
    const ssize_t sent = send(socket, text.data(), text.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(sent));
  }
  return true;
}

bool send_answer(int socket, const char* status, const char* kind, std::string_view text) {
  return send_all(socket, fmt::format("HTTP/1.1 {}\r\nContent-Type: {}\r\nContent-Length: {}\r\n"
                                      "Cache-Control: no-store\r\n\r\n",
                                      status, kind, text.size())) &&
         send_all(socket, text);
}

// Appends received bytes to the buffer; returns false if there were none
bool receive(int socket, std::string& buffer) {
  char bytes[4096];
  ssize_t count = 0;
  do count = recv(socket, bytes, sizeof bytes, 0);
  while (count < 0 && errno == EINTR);
  if (count > 0) buffer.append(bytes, static_cast<std::size_t>(count));
  return count > 0;
}

std::string in_small_letters(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  });
  return text;
}

// Returns the value of a field in the head of a request, such as "Host: localhost:8642"
std::string field(const std::string& head, const std::string& name) {
  const std::string small = in_small_letters(head), start = "\r\n" + name + ":";
  const std::size_t found = small.find(start);
  if (found == std::string::npos) return "";
  const std::size_t from = head.find_first_not_of(' ', found + start.size()),
                    to = head.find("\r\n", from);
  return head.substr(from, to - from);
}

// Returns true if the request is for a name of this machine and comes from a page of this server. A
// browser shows pages of other servers too; they may not speak to this server.
bool is_ours(const std::string& host, const std::string& origin) {
  const std::string name = host.substr(0, host.find(':'));
  return (name == "127.0.0.1" || name == "localhost") &&
         (origin.empty() || origin == "http://" + host);
}

int listen_on(int port) {
  if (port < 0 || port > 65535)
    throw InputError(fmt::format("port: expected 0 to 65535, got {}", port));
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET, address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      listen(socket, 16) == 0)
    return socket;
  const int why = errno;
  close(socket);
  throw InputError(why == EADDRINUSE
                       ? fmt::format("port {} is in use, perhaps by another view: end that, or "
                                     "choose another port (0: any free one)",
                                     port)
                       : fmt::format("cannot listen on port {}: {}", port, std::strerror(why)));
}

}  // namespace

Port::Port(int number) : socket_(listen_on(number)) {}

Port::~Port() { close(socket_); }

int Port::number() const {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

WebServer::WebServer(const Port& port, std::string page, Take take)
    : page_(std::move(page)), take_(std::move(take)), listener_(port.socket()) {
  thread_ = std::thread([this] { accept_all(); });
}

WebServer::~WebServer() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    shutdown(listener_, SHUT_RDWR);
    for (const Connection& one : connections_)
      if (!one.over) shutdown(one.socket, SHUT_RDWR);
  }
  news_.notify_all();
  thread_.join();
  for (Connection& one : connections_) one.thread.join();
}

void WebServer::publish(std::string frame) {
  {
    const std::lock_guard lock(mutex_);
    frame_ = std::make_shared<const std::string>("data: " + std::move(frame) + "\n\n");
    ++frames_;
  }
  news_.notify_all();
}

int WebServer::watchers() const {
  const std::lock_guard lock(mutex_);
  return watchers_;
}

void WebServer::accept_all() {
  while (true) {
    const int socket = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    const std::lock_guard lock(mutex_);
    if (ending_) {
      if (socket >= 0) close(socket);
      return;
    }
    connections_.remove_if([](Connection& one) {
      if (one.over) one.thread.join();
      return one.over;
    });
    if (socket < 0) {  // a connection that ended at once, or too many files are open
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      continue;
    }
    const int on = 1;
    setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    Connection& made = connections_.emplace_back();
    made.socket = socket;
    made.thread = std::thread([this, &made] { talk(made); });
  }
}

void WebServer::talk(Connection& connection) {
  std::string buffer;
  for (Request request;
       read_request(connection.socket, buffer, request) && answer(connection.socket, request);)
    request = {};
  const std::lock_guard lock(mutex_);
  close(connection.socket);
  connection.over = true;
}

bool WebServer::read_request(int socket, std::string& buffer, Request& request) const {
  std::size_t end = 0;
  while ((end = buffer.find("\r\n\r\n")) == std::string::npos)
    if (buffer.size() > longest_head || !receive(socket, buffer)) return false;
  const std::string head = buffer.substr(0, end + 2);
  buffer.erase(0, end + 4);
  const std::size_t first = head.find(' '), second = head.find(' ', first + 1);
  if (second == std::string::npos) return false;
  request.method = head.substr(0, first), request.path = head.substr(first + 1, second - first - 1);
  request.host = field(head, "host"), request.origin = field(head, "origin");
  std::size_t size = 0;
  const std::string length = field(head, "content-length");
  std::from_chars(length.data(), length.data() + length.size(), size);
  if (size > longest_body) return false;
  while (buffer.size() < size)
    if (!receive(socket, buffer)) return false;
  request.body = buffer.substr(0, size);
  buffer.erase(0, size);
  return true;
}

// Answers a request; returns whether the connection stays open
bool WebServer::answer(int socket, const Request& request) {
  constexpr const char* words = "text/plain; charset=utf-8";
  if (!is_ours(request.host, request.origin))
    return send_answer(socket, "403 Forbidden", words, "not from here\n");
  if (request.method == "GET" && request.path == "/")
    return send_answer(socket, "200 OK", "text/html; charset=utf-8", page_);
  if (request.method == "GET" && request.path == "/frames") return send_frames(socket), false;
  if (request.method == "POST" && request.path == "/controls") {
    const std::string wrong = take_(request.body);
    return send_answer(socket, wrong.empty() ? "200 OK" : "400 Bad Request", words, wrong);
  }
  return send_answer(socket, "404 Not Found", words, "there is / here, /frames and /controls\n");
}

void WebServer::send_frames(int socket) {
  bool on = send_all(
      socket,
      "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\n\r\n");
  std::unique_lock lock(mutex_);
  ++watchers_;
  for (long sent = 0; on && !ending_;) {
    news_.wait_for(lock, between_signs_of_life, [&] { return ending_ || frames_ > sent; });
    const auto frame = frames_ > sent ? frame_ : nullptr;
    sent = frames_;
    lock.unlock();
    on = send_all(socket, frame ? std::string_view(*frame) : ":\n\n");
    lock.lock();
  }
  --watchers_;
}

}  // namespace plica::app
