// h5py and this module use one HDF5, which knows nothing of threads: while h5py is there, its lock is taken around each
// of our calls.
#include "core.hpp"

#include <boltzmann/files/hdf5_file.hpp>

#include <atomic>

namespace boltzmann::python {
namespace {

std::atomic<bool> h5py_is_there = false;
py::object* lock_of_h5py = nullptr;  // written before the flag is set, and never again
thread_local int taken = 0;

void enter() {
  if (!h5py_is_there) return;
  py::gil_scoped_acquire const interpreter;
  lock_of_h5py->attr("acquire")();  // gives the interpreter away while it waits
  ++taken;
}

void leave() {
  if (taken == 0) return;
  --taken;
  py::gil_scoped_acquire const interpreter;
  lock_of_h5py->attr("release")();
}

}  // namespace

void share_hdf5() { hdf5::share_with({enter, leave}); }

void look_for_h5py() {
  if (h5py_is_there) return;
  PyObject* const module = PyDict_GetItemString(PyImport_GetModuleDict(), "h5py._objects");
  if (!module) return;
  lock_of_h5py = new py::object(py::handle(module).attr("phil"));
  h5py_is_there = true;
}

}  // namespace boltzmann::python
