// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <condition_variable>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace plica::app {

/// Port of this machine (127.0.0.1), open while the object exists. A browser that connects to it
/// waits until a WebServer answers.
class Port {
 public:
  /// Opens the port; 0: any free one. Throws InputError if it is in use or not allowed.
  explicit Port(int number);
  ~Port();
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  int number() const;                     ///< number of the port
  int socket() const { return socket_; }  ///< file descriptor of the listening socket

 private:
  int socket_;
};

/// Serves one page to browsers on this machine, on its own threads, until it is destroyed. GET /
/// returns the page. GET /frames returns the frames as server-sent events
/// (https://html.spec.whatwg.org/multipage/server-sent-events.html). POST /controls takes messages
/// of the page.
class WebServer {
 public:
  /// Function that takes a message of the page, on another thread. It returns an empty text, or
  /// what is wrong with the message.
  using Take = std::function<std::string(const std::string&)>;
  /// Starts the server. The port must outlive it, and cannot be used by another server afterwards.
  WebServer(const Port& port, std::string page, Take take);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// Sends a frame, one line of text, to all open pages. Does not wait: a slow page misses frames.
  void publish(std::string frame);
  /// Returns the number of open pages.
  int watchers() const;

 private:
  struct Connection {
    int socket = -1;
    bool over = false;
    std::thread thread;
  };
  struct Request {
    std::string method, path, host, origin, body;
  };
  void accept_all();
  void talk(Connection& connection);
  bool read_request(int socket, std::string& buffer, Request& request) const;
  bool answer(int socket, const Request& request);
  void send_frames(int socket);

  std::string page_;
  Take take_;
  int listener_ = -1;
  mutable std::mutex mutex_;  // protects all members below
  std::condition_variable news_;
  std::shared_ptr<const std::string> frame_;
  long frames_ = 0;
  int watchers_ = 0;
  bool ending_ = false;
  std::list<Connection> connections_;
  std::thread thread_;
};

}  // namespace plica::app
