// The types of Boost.Asio, and the limits, that the server, its connections and its browsers share. Private to this room.
#pragma once

#define BOOST_ASIO_DISABLE_FENCED_BLOCK  // one thread has nobody to keep in step with
#include <boltzmann/core/clock.hpp>

#include <boost/asio/basic_stream_socket.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

namespace boltzmann::web {

namespace asio = boost::asio;
using boost::system::error_code;
using tcp = asio::ip::tcp;
// Sockets and clocks of this context only, which spares every operation an indirection.
using Executor = asio::io_context::executor_type;
using Socket = asio::basic_stream_socket<tcp, Executor>;
using Timer = asio::basic_waitable_timer<Clock, asio::wait_traits<Clock>, Executor>;

// A message leaves in frames of at most so many bytes: between two of them a pong may be sent, a browser may be let go,
// and a slow line shows that it is alive.
constexpr std::size_t frame_bytes = 1U << 18U;
// A closed connection may finish reading what it was told for so many seconds.
constexpr double close_timeout = 1;

}  // namespace boltzmann::web
