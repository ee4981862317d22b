# SceneForge and w2m in a container. From a clone:
#   docker build --tag world2minecraft .
#   docker run --rm --publish 127.0.0.1:8484:8484 --volume "$PWD/rooms:/rooms" world2minecraft
# Open the link that it prints. Other commands: docker run ... world2minecraft demo --out /rooms/OUT
FROM python:3.13-slim

ENV PIP_NO_CACHE_DIR=1 PIP_DISABLE_PIP_VERSION_CHECK=1 PYTHONUNBUFFERED=1

WORKDIR /source
COPY pyproject.toml constraints.txt README.md LICENSE NOTICE ./
COPY src ./src
RUN python -m pip install --constraint constraints.txt '.[capture,vln]' \
  && rm -r /source/src \
  && useradd --create-home --uid 1000 w2m \
  && mkdir /rooms \
  && chown w2m /rooms

USER w2m
WORKDIR /rooms
# For the processor of the machine that builds. On another one, the first use compiles.
RUN w2m doctor --warm

VOLUME /rooms
EXPOSE 8484
ENTRYPOINT ["w2m"]
CMD ["forge", "--host", "0.0.0.0", "--port", "8484", "--home", "/rooms/SceneForge", "--no-browser"]
