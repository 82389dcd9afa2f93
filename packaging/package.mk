# Packages of what is in the source tree; results are in build/package.
.PHONY: package tarball package-test

# boltzmann_*.deb, libboltzmann-dev_*.deb and python3-boltzmann_*.deb, for Debian 12 and any x86-64.
package: package-build
	cd build/package && rm -f *.deb && cpack -G DEB
	@ls -1 $(CURDIR)/build/package/*.deb

# For other systems: the command with everything but libc linked in.
tarball: package-build
	cmake --build build/package --target portable
	cd build/package && rm -f *.tar.gz && cpack -G TGZ
	@ls -1 $(CURDIR)/build/package/*.tar.gz

# Both, in a bare Debian 12 (needs root, and the network of apt-get).
package-test: package tarball
	@packaging/need.sh debootstrap
	tests/package/bare_debian.sh build/package

.PHONY: package-build
package-build:
	@packaging/need.sh $$(cat dependencies.txt packaging/python.txt) dpkg-dev file
	@packaging/versions.sh
	cmake -S . -B build/package -G Ninja -DCMAKE_BUILD_TYPE=Release -DBOLTZMANN_SETS=all -DBOLTZMANN_TESTS=OFF -DBOLTZMANN_ARCHIVES=OFF -DBOLTZMANN_PYTHON=ON -DPython_EXECUTABLE=/usr/bin/python3 -DCMAKE_INSTALL_PREFIX=/usr
	cmake --build build/package --target installable
