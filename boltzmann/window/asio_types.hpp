// The Boost.Asio types and limits shared by the server, its connections and its browsers. Private to this module.
#pragma once

#define BOOST_ASIO_DISABLE_FENCED_BLOCK  // a single thread needs no fences
#include <boltzmann/core/clock.hpp>

#include <boost/asio/basic_stream_socket.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

namespace boltzmann::web {

namespace asio = boost::asio;
using boost::system::error_code;
using tcp = asio::ip::tcp;
// Sockets and clocks are bound to this context type, which avoids type-erased executors.
using Executor = asio::io_context::executor_type;
using Socket = asio::basic_stream_socket<tcp, Executor>;
using Timer = asio::basic_waitable_timer<Clock, asio::wait_traits<Clock>, Executor>;

// A message is sent in frames of at most this size. Between two frames a pong can be sent and a browser can be dropped,
// and a slow line shows progress.
constexpr std::size_t frame_bytes = 1U << 18U;
// Seconds in which a closed connection may finish reading its answer.
constexpr double close_timeout = 1;

}  // namespace boltzmann::web
