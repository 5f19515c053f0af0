"""The version of the package, which is also that of the program and of the library."""

VERSION = "0.1.0"
