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

/// A port of this machine (127.0.0.1), taken from here to the end of the scope. Who connects to it
/// waits until a WebServer answers.
class Port {
 public:
  /// 0: any that is free. InputError where it is in use, or not ours to take.
  explicit Port(int number);
  ~Port();
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  int number() const;
  int socket() const { return socket_; }

 private:
  int socket_;
};

/// Serves one page to browsers on this machine: GET / is the page, GET /frames the frames as
/// server-sent events (https://html.spec.whatwg.org/multipage/server-sent-events.html), POST
/// /controls takes what the page says. Threads of its own do that, until it is destroyed.
class WebServer {
 public:
  /// take(text) is called with each message of the page, on another thread; an empty answer:
  /// understood, else what is wrong with it.
  using Take = std::function<std::string(const std::string&)>;
  /// The port outlasts it, and is of no use to another server.
  WebServer(const Port& port, std::string page, Take take);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// Sends a frame, one line of text, to whoever watches. Does not wait: who is slow misses some.
  void publish(std::string frame);
  /// How many pages watch.
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
  mutable std::mutex mutex_;  // of all below
  std::condition_variable news_;
  std::shared_ptr<const std::string> frame_;
  long frames_ = 0;
  int watchers_ = 0;
  bool ending_ = false;
  std::list<Connection> connections_;
  std::thread thread_;
};

}  // namespace plica::app
