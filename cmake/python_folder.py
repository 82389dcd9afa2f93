"""Where a package goes under a prefix: where this Python looks, if that is there, else lib/python3/dist-packages."""

import os
import site
import sys

prefix = os.path.abspath(sys.argv[1])
folders = [os.path.relpath(folder, prefix) for folder in site.getsitepackages()]
print(next((folder for folder in folders if folder.startswith("lib" + os.sep)), "lib/python3/dist-packages"))
