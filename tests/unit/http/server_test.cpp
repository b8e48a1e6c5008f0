// SPDX-License-Identifier: Apache-2.0
#include "http/server.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "base/error.h"
#include "support/http_client.h"

namespace orrery::http {
namespace {

using support::http_request;

Response text(const std::string& body) { return {200, "text/plain", std::make_shared<const std::string>(body)}; }

bool everybody(const Request&) { return true; }

TEST(HttpServer, PassesRequestsAndResponses) {
  Request last;
  const auto server = serve("127.0.0.1", 0, everybody, [&](const Request& request) {
    last = request;
    Response out = text("answer");
    out.fields.emplace_back("X-Own", "1");
    return out;
  });
  ASSERT_GT(server.port, 0);
  const auto answer = http_request(server.port, "POST", "/path?a=1&b=two%20words",
                                   "Authorization: a b\r\nOrigin: http://o\r\n", "body");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body, "answer");
  EXPECT_NE(answer.header.find("X-Own: 1"), std::string::npos) << answer.header;
  EXPECT_EQ(last.method, "POST");
  EXPECT_EQ(last.path, "/path");
  EXPECT_EQ(last.query.at("a"), "1");
  EXPECT_EQ(last.query.at("b"), "two words");
  EXPECT_EQ(last.authorization, "a b");
  EXPECT_EQ(last.origin, "http://o");
  EXPECT_EQ(last.host, "127.0.0.1:" + std::to_string(server.port));
  EXPECT_EQ(last.body, "body");
}

TEST(HttpServer, LargeResponsesArriveInFull) {
  std::string large(5'000'000, 'x');
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = static_cast<char>('a' + i % 23);
  const auto server = serve("127.0.0.1", 0, everybody, [&](const Request&) { return text(large); });
  EXPECT_EQ(http_request(server.port, "GET", "/").body, large);
}

TEST(HttpServer, BodiesAreLimited) {
  std::atomic<int> calls{0};
  const auto server = serve("127.0.0.1", 0, everybody, [&](const Request& request) {
    ++calls;
    return text(std::to_string(request.body.size()));
  });
  EXPECT_EQ(http_request(server.port, "POST", "/", {}, std::string(kLargestBody, 'x')).body, "65536");
  EXPECT_EQ(http_request(server.port, "POST", "/", {}, std::string(kLargestBody + 1, 'x')).status, 413);
  EXPECT_EQ(calls, 1) << "the handler does not see a body that is too large";
}

TEST(HttpServer, HeadersAreLimited) {
  const auto server = serve("127.0.0.1", 0, everybody, [](const Request&) { return text(""); });
  EXPECT_GE(http_request(server.port, "GET", "/", "X-Long: " + std::string(100'000, 'x') + "\r\n").status, 400);
  EXPECT_EQ(http_request(server.port, "GET", "/").status, 200) << "the server still answers";
}

TEST(HttpServer, WhatIsNotHttpIsRefused) {
  const auto server = serve("127.0.0.1", 0, everybody, [](const Request&) { return text(""); });
  for (const char* bytes : {"nonsense\r\n\r\n", "GET\r\n\r\n", "GET / HTTP/9.9\r\n\r\n", "\xff\xfe\r\n\r\n"}) {
    const support::HttpConnection connection(server.port);
    connection.send(bytes);
    const std::string answer = connection.receive();
    EXPECT_EQ(answer.find(" 200 "), std::string::npos) << bytes << answer;
  }
  EXPECT_EQ(http_request(server.port, "GET", "/").status, 200) << "the server still answers";
}

TEST(HttpServer, AHandlerThatThrowsIsAnErrorOfTheServer) {
  const auto server =
      serve("127.0.0.1", 0, everybody, [](const Request&) -> Response { throw std::runtime_error("wrong"); });
  EXPECT_EQ(http_request(server.port, "GET", "/").status, 500);
}

TEST(HttpServer, AWaitingHandlerBlocksNobody) {
  std::mutex mutex;
  std::condition_variable wake;
  bool goes_on = false;
  const auto server = serve("127.0.0.1", 0, everybody, [&](const Request& request) {
    std::unique_lock lock(mutex);
    if (request.path == "/wait") wake.wait(lock, [&] { return goes_on; });
    return text(request.path);
  });
  std::thread waits([&] { EXPECT_EQ(http_request(server.port, "GET", "/wait").body, "/wait"); });
  EXPECT_EQ(http_request(server.port, "GET", "/other").body, "/other");
  {
    const std::lock_guard lock(mutex);
    goes_on = true;
  }
  wake.notify_all();
  waits.join();
}

TEST(HttpServer, ZeroBytesDoNotEndATarget) {
  Request last;
  const auto server = serve("127.0.0.1", 0, everybody, [&](const Request& request) {
    last = request;
    return text("");
  });
  http_request(server.port, "GET", "/view.js%00?a=1%002");
  EXPECT_EQ(last.path.substr(0, 8), "/view.js");
  EXPECT_EQ(last.path.size(), 9u);
  EXPECT_EQ(last.query.at("a").size(), 3u);
}

bool is_client(const Request& request) { return request.authorization == "secret"; }

TEST(HttpServer, StrangersAreAnsweredOnce) {
  const auto server = serve("127.0.0.1", 0, is_client, [](const Request& request) { return text(request.path); });
  const support::HttpConnection stranger(server.port);
  stranger.send("GET /first HTTP/1.1\r\nHost: a\r\n\r\n");
  const std::string answer = stranger.receive();
  EXPECT_NE(answer.find("Connection: close"), std::string::npos) << answer;
  EXPECT_NE(answer.find("/first"), std::string::npos) << answer;
  EXPECT_EQ(http_request(server.port, "GET", "/", "Authorization: secret\r\n").body, "/");
}

TEST(HttpServer, StrangersDoNotLockClientsOut) {
  const auto server = serve("127.0.0.1", 0, is_client, [](const Request& request) { return text(request.path); });
  const support::HttpConnection client(server.port);
  client.send("GET /first HTTP/1.1\r\nHost: a\r\nAuthorization: secret\r\n\r\n");
  char first = 0;
  client.receive(&first, 1);
  std::deque<support::HttpConnection> strangers;
  for (int i = 0; i < 300; ++i) strangers.emplace_back(server.port);  // more than the server has at once
  std::atomic<bool> ends{false};
  std::thread slow([&] {  // never silent
    while (!ends) {
      for (const support::HttpConnection& stranger : strangers) stranger.send("x");
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  });
  EXPECT_EQ(http_request(server.port, "GET", "/other").body, "/other");
  client.send("GET /second HTTP/1.1\r\nHost: a\r\nAuthorization: secret\r\nConnection: close\r\n\r\n");
  const std::string answers = client.receive();
  EXPECT_NE(answers.find("/first"), std::string::npos) << answers;
  EXPECT_NE(answers.find("/second"), std::string::npos) << "it was closed with the strangers";
  ends = true;
  slow.join();
}

TEST(HttpServer, SilentStrangersAreClosed) {
  const auto server = serve("127.0.0.1", 0, is_client, [](const Request&) { return text(""); });
  const support::HttpConnection silent(server.port);
  silent.send("GET / HT");
  EXPECT_EQ(silent.receive(), "");
}

TEST(HttpServer, APortInUseIsAnError) {
  const auto server = serve("127.0.0.1", 0, everybody, [](const Request&) { return text(""); });
  try {
    serve("127.0.0.1", server.port, everybody, [](const Request&) { return text(""); });
    FAIL() << "the port is in use";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.kind(), base::ErrorKind::kCannotCreate);
    EXPECT_NE(std::string(error.what()).find("--port"), std::string::npos) << error.what();
  }
  EXPECT_THROW(serve("example.org", 0, everybody, [](const Request&) { return text(""); }), base::Error);
}

}  // namespace
}  // namespace orrery::http
