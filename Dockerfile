# drakegait in a container: pinned Python packages, an ordinary user, results in a mounted folder.
#
# Build:  docker build -t drakegait .
# Run:    mkdir -p out && docker run --rm -it --init --user "$(id -u):$(id -g)" \
#             -v "$PWD/out:/out" drakegait walk --out /out/walk
#
# The files of the run are then in out/walk. Any drakegait command may stand in place of `walk ...`;
# paths are relative to /out. Ctrl-C ends a solve with the best gait so far. A replay
# that is watched live needs its port too: --publish 7000:7000.
#
# Pinned: the base image by digest, every Python package by version and hash (requirements/run.txt).
# Debian's own packages follow the security updates of Debian 13; Drake brings MOSEK's library along,
# which drakegait does not use.
FROM debian:trixie-20260918-slim@sha256:a99cfc517144bc59b1978475ec53b46ecabec7e43635402ee5b77cc54cd1b20a

# libglib2.0 is the one library that Drake's wheel expects from the system.
RUN apt-get update \
    && DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends \
        libglib2.0-0t64 python3 python3-venv \
    && rm -rf /var/lib/apt/lists/*

RUN python3 -m venv /opt/venv
ENV PATH=/opt/venv/bin:/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    PIP_DISABLE_PIP_VERSION_CHECK=1 \
    PIP_NO_CACHE_DIR=1

# The packages come first: they change seldom and are most of the image.
WORKDIR /opt/drakegait
COPY requirements/run.txt requirements/run.txt
RUN pip install --quiet --require-hashes --requirement requirements/run.txt

COPY pyproject.toml README.md LICENSE NOTICE ./
COPY sdf sdf
COPY drakegait drakegait
RUN pip install --quiet --no-deps --no-build-isolation .

# Drake's IPOPT wants OMP_CANCELLATION; the other two keep matplotlib off the home folder, which a
# user given by number does not have.
ENV OMP_CANCELLATION=TRUE \
    MPLBACKEND=Agg \
    MPLCONFIGDIR=/tmp/matplotlib

RUN useradd --uid 1000 --create-home walker && install --directory --owner walker --mode 0777 /out
USER walker
WORKDIR /out
VOLUME /out
ENTRYPOINT ["drakegait"]
CMD ["--help"]
