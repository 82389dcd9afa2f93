// Decompression by zlib, member by member.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/gzip_stream.hpp>

#include <zlib.h>

namespace boltzmann {

struct GzipBuffer::State {
  z_stream stream{};
  bool inside = true;  ///< within a member
};

GzipBuffer::GzipBuffer(std::string path)
    : path_(std::move(path)), file_(path_, std::ios::binary), state_(std::make_unique<State>()) {
  constexpr int gzip_only = 15 + 16;  // largest window, gzip header
  if (inflateInit2(&state_->stream, gzip_only) != Z_OK) throw Error("'" + path_ + "': there is no memory to read it");
}

GzipBuffer::~GzipBuffer() { inflateEnd(&state_->stream); }

void GzipBuffer::refuse(std::string const& what) const { throw Error("'" + path_ + "' " + what); }

bool GzipBuffer::refill() {
  z_stream& stream = state_->stream;
  if (stream.avail_in > 0) return true;
  file_.read(packed_.data(), static_cast<std::streamsize>(packed_.size()));
  if (file_.bad()) refuse("can't be read");
  stream.next_in = reinterpret_cast<Bytef*>(packed_.data());
  stream.avail_in = static_cast<uInt>(file_.gcount());
  return stream.avail_in > 0;
}

GzipBuffer::int_type GzipBuffer::underflow() {
  z_stream& stream = state_->stream;
  stream.next_out = reinterpret_cast<Bytef*>(plain_.data());
  stream.avail_out = static_cast<uInt>(plain_.size());
  while (stream.avail_out == plain_.size()) {
    if (!refill()) {
      if (state_->inside) refuse("is truncated: the compressed data ends too early");
      return traits_type::eof();
    }
    if (!state_->inside) {
      inflateReset(&stream);
      state_->inside = true;
    }
    int const status = inflate(&stream, Z_NO_FLUSH);
    if (status == Z_STREAM_END)
      state_->inside = false;
    else if (status != Z_OK && status != Z_BUF_ERROR)
      refuse(std::string("is damaged: ") + (stream.msg ? stream.msg : "it is no gzip file"));
  }
  setg(plain_.data(), plain_.data(), plain_.data() + (plain_.size() - stream.avail_out));
  return traits_type::to_int_type(*gptr());
}

}  // namespace boltzmann
